#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "footprint.h"
#include "label_sets.h"
#include "lidar_obstacles/clustering.h"

namespace lidar_obstacles {
namespace {

/// What is asked of all pairs of components.
struct Pieces {
    const std::vector<Cluster>& components;
    const PointCloud& cloud;
    const GroundModel& ground;
    const ClusteringParams& params;
    std::vector<Footprint> footprint;
};

bool fitsVehicle(const Footprint& a, const Footprint& b, double max_length, const ClusteringParams& params) {
    const double longest = std::hypot(max_length, params.join_max_width);
    if (a.box.merged(b.box).sizes().maxCoeff() > longest) return false;
    const cv::Size2f size = cv::minAreaRect(merged(a, b).outline).size;
    return std::max(size.width, size.height) <= max_length &&
           std::min(size.width, size.height) <= params.join_max_width;
}

/// Heights of a component above the ground [m], and whether its top is known: the highest plane did not hit it.
struct Heights {
    float bottom = 1e9f;
    float top = 0.0f;
    bool open = false;
};

Heights heightsOf(const Pieces& pieces, int c) {
    Heights h;
    for (const std::int32_t i : pieces.components[c].points) {
        h.bottom = std::min(h.bottom, pieces.ground.height[i]);
        h.top = std::max(h.top, pieces.ground.height[i]);
        h.open |= pieces.cloud.ring[i] + 1 == pieces.cloud.view.rings;
    }
    return h;
}

/// A narrow component that reaches from near the ground to a person's height stands by itself; so does one beside the
/// sensor, whose top no plane passed over.
bool likePerson(const Pieces& pieces, int c) {
    if (pieces.footprint[c].box.sizes().maxCoeff() > 1.0f) return false;
    const Heights h = heightsOf(pieces, c);
    return h.bottom < 0.8f && (h.top > 1.3f || h.open);
}

/// For each return the component it belongs to, or -1.
std::vector<int> componentOfReturn(const std::vector<Cluster>& components, std::size_t returns) {
    std::vector<int> component(returns, -1);
    for (std::size_t c = 0; c < components.size(); ++c)
        for (const std::int32_t i : components[c].points) component[i] = static_cast<int>(c);
    return component;
}

using Pair = std::pair<int, int>;
constexpr int kMinSteps = 3;
constexpr float kMaxHood = 1.2f;  // a beam that passes over something higher did not pass over a hood [m]

/// How many azimuth columns show one component right above and behind another: the next plane up passes over a hood
/// and hits the windscreen.
std::map<Pair, int> countSteps(const Pieces& pieces) {
    const PointCloud& cloud = pieces.cloud;
    const std::vector<int> component = componentOfReturn(pieces.components, cloud.size());
    std::map<Pair, int> steps;
    for (std::size_t c = 0; c < pieces.components.size(); ++c) {
        const Heights h = heightsOf(pieces, static_cast<int>(c));
        if (h.open && h.top < kMaxHood) continue;  // no plane passed over it
        for (const std::int32_t i : pieces.components[c].points) {
            if (pieces.ground.height[i] > kMaxHood || cloud.ring[i] + 1 >= cloud.view.rings) continue;
            const std::int32_t j = cloud.view.at(cloud.ring[i] + 1, cloud.view.column_of[i]);
            if (j < 0 || component[j] < 0 || component[j] == static_cast<int>(c)) continue;
            const float run = (cloud.xyz[j].head<2>() - cloud.xyz[i].head<2>()).norm();
            if (run <= pieces.params.join_depth) ++steps[std::minmax(static_cast<int>(c), component[j])];
        }
    }
    return steps;
}

/// The shortest way between the outlines of two components.
struct Gap {
    std::int32_t from = -1;  ///< return of the one component
    std::int32_t to = -1;    ///< of the other
    float length = 1e9f;     ///< [m]
};

Gap gapBetween(const Footprint& a, const Footprint& b) {
    Gap gap;
    for (std::size_t m = 0; m < a.outline.size(); ++m)
        for (std::size_t n = 0; n < b.outline.size(); ++n) {
            const float length = std::hypot(a.outline[m].x - b.outline[n].x, a.outline[m].y - b.outline[n].y);
            if (length < gap.length) gap = {a.returns[m], b.returns[n], length};
        }
    return gap;
}

float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Where a beam ended with regard to the gap between two components.
enum class Beam : std::uint8_t { Elsewhere, Before, Through };

/// Through: it passed where a vehicle would have stopped it, below its windows. Before: something nearer ended it.
Beam beamAcross(const Pieces& pieces, const Gap& gap, std::int32_t i) {
    constexpr float kLowest = 0.1f;
    constexpr float kWindows = 0.8f;
    constexpr float kApart = 0.5f;
    const PointCloud& cloud = pieces.cloud;
    const Eigen::Vector2f sensor = cloud.sensor_origin.head<2>();
    const Eigen::Vector2f from = cloud.xyz[gap.from].head<2>() - sensor;
    const Eigen::Vector2f along = cloud.xyz[gap.to].head<2>() - cloud.xyz[gap.from].head<2>();
    const Eigen::Vector2f beam = cloud.xyz[i].head<2>() - sensor;
    const float turn = cross(beam, along);
    if (std::abs(turn) < 1e-6f) return Beam::Elsewhere;
    const float share = cross(from, along) / turn;  // of the beam in front of the gap
    const float beyond = (1.0f - share) * beam.norm();
    if (share > 1.0f && beyond < -kApart && !pieces.ground.is_ground[i]) return Beam::Before;
    if (share <= 0.0f || beyond < kApart) return Beam::Elsewhere;
    const float sensor_height = cloud.sensor_origin.z() - cloud.xyz[i].z() + pieces.ground.height[i];
    const float height = sensor_height + share * (pieces.ground.height[i] - sensor_height);
    return height > kLowest && height < kWindows ? Beam::Through : Beam::Elsewhere;
}

/// What a column of the scan shows between two components.
Beam columnAcross(const Pieces& pieces, const Gap& gap, int column) {
    const OrganizedView& view = pieces.cloud.view;
    Beam seen = Beam::Elsewhere;
    for (int ring = 0; ring < view.rings; ++ring) {
        const std::int32_t i = view.at(ring, column);
        if (i < 0) continue;
        const Beam beam = beamAcross(pieces, gap, i);
        if (beam == Beam::Through) return beam;
        if (beam == Beam::Before) seen = beam;
    }
    return seen;
}

/// Is nothing seen between two components that lie beside each other? Beams that ended in the gap or never came back do
/// not part them; beams through it do, and so does something that stands before the most part of it.
bool nothingBetween(const Pieces& pieces, const Gap& gap, bool may_be_hidden) {
    constexpr int kMinColumns = 2;
    constexpr double kFreeShare = 0.2;
    constexpr double kHiddenShare = 0.5;
    const OrganizedView& view = pieces.cloud.view;
    int first = view.column_of[gap.from];
    int columns = view.wrap(view.column_of[gap.to] - first);
    if (columns > view.columns / 2) {
        first = view.column_of[gap.to];
        columns = view.columns - columns;
    }
    const int between = columns - 1;
    if (between < kMinColumns) return false;
    int free = 0;
    int hidden = 0;
    for (int k = 1; k < columns; ++k) {
        const Beam seen = columnAcross(pieces, gap, view.wrap(first + k));
        free += seen == Beam::Through;
        hidden += seen == Beam::Before;
    }
    return free <= kFreeShare * between && (may_be_hidden || hidden <= kHiddenShare * between);
}

/// Did one plane of the sensor hit the outlines of both?
bool sharePlane(const Footprint& a, const Footprint& b, const PointCloud& cloud) {
    return std::any_of(a.returns.begin(), a.returns.end(), [&](std::int32_t i) {
        return std::any_of(b.returns.begin(), b.returns.end(),
                           [&](std::int32_t j) { return cloud.ring[i] == cloud.ring[j]; });
    });
}

/// Are these two pieces of one vehicle, as far as what lies between them tells?
bool belongTogether(const Pieces& pieces, const Pair& pair, int steps) {
    constexpr float kMinPiece = 0.9f;
    constexpr std::size_t kFew = 5;    // returns of what cannot stand by itself
    constexpr std::size_t kMany = 20;  // returns of what needs no speck from behind something else
    const Footprint& a = pieces.footprint[pair.first];
    const Footprint& b = pieces.footprint[pair.second];
    if (steps >= kMinSteps) return true;
    const auto [fewer, more] =
        std::minmax({pieces.components[pair.first].points.size(), pieces.components[pair.second].points.size()});
    const float larger = std::max(a.box.sizes().maxCoeff(), b.box.sizes().maxCoeff());
    if (fewer >= kFew && larger < kMinPiece) return false;              // they may be people
    if (fewer < kFew && !sharePlane(a, b, pieces.cloud)) return false;  // a speck beside it, hit by other planes only
    const Gap gap = gapBetween(a, b);
    return gap.length < pieces.params.join_gap && nothingBetween(pieces, gap, fewer >= kFew || more < kMany);
}

/// Pairs of components that are near each other, with the number of their steps.
std::map<Pair, int> nearPairs(const Pieces& pieces) {
    std::map<Pair, int> pairs = countSteps(pieces);
    const double longest = std::hypot(pieces.params.join_max_length, pieces.params.join_max_width);
    const auto count = static_cast<int>(pieces.components.size());
    for (int a = 0; a < count; ++a) {
        if (pieces.footprint[a].box.sizes().maxCoeff() > longest) continue;
        for (int b = a + 1; b < count; ++b)
            if (pieces.footprint[a].box.exteriorDistance(pieces.footprint[b].box) < pieces.params.join_gap)
                pairs.try_emplace({a, b}, 0);
    }
    return pairs;
}

/// Moves the returns of each set into its first component.
void merge(std::vector<Cluster>& components, LabelSets& sets) {
    for (int c = static_cast<int>(components.size()) - 1; c >= 0; --c) {
        const int into = sets.find(c);
        if (into == c) continue;
        Cluster& target = components[into];
        target.points.insert(target.points.end(), components[c].points.begin(), components[c].points.end());
        components[c].points.clear();
    }
    components.erase(
        std::remove_if(components.begin(), components.end(), [](const Cluster& c) { return c.points.empty(); }),
        components.end());
}

}  // namespace

std::vector<Cluster> joinFragments(std::vector<Cluster> components, const PointCloud& cloud, const GroundModel& ground,
                                   const ClusteringParams& params) {
    if (cloud.view.empty()) return components;
    Pieces pieces{components, cloud, ground, params, {}};
    for (const Cluster& c : components) pieces.footprint.push_back(footprintOf(c.points, cloud));
    const std::map<Pair, int> pairs = nearPairs(pieces);
    LabelSets sets(static_cast<int>(components.size()));
    std::vector<Footprint> joined = pieces.footprint;
    for (const auto& [pair, steps] : pairs) {
        const int a = sets.find(pair.first);
        const int b = sets.find(pair.second);
        if (a == b || !belongTogether(pieces, pair, steps)) continue;
        const double max_length = steps >= kMinSteps ? params.join_max_length : params.join_gap_length;
        if (!fitsVehicle(joined[a], joined[b], max_length, params)) continue;
        if (likePerson(pieces, pair.first) || likePerson(pieces, pair.second)) continue;
        joined[std::min(a, b)] = merged(joined[a], joined[b]);
        sets.join(a, b);
    }
    merge(components, sets);
    return components;
}

}  // namespace lidar_obstacles
