#include <algorithm>
#include <bitset>
#include <cmath>
#include <set>

#include "footprint.h"
#include "join_gap.h"
#include "label_sets.h"
#include "lidar_obstacles/clustering.h"

namespace lidar_obstacles {
namespace {

constexpr std::size_t kMostPlanes = 128;

/// What is known of a component beside its returns.
struct Piece {
    Eigen::AlignedBox2f box;  ///< [m]
    float bottom = 1e9f;      ///< height above the ground [m]
    float top = 0.0f;
    bool open = false;                ///< the highest plane hit it: its top is not known
    bool like_person = false;         ///< may be one, and stands by itself
    std::bitset<kMostPlanes> planes;  ///< that hit it
    Footprint footprint;              ///< made when first asked for

    float size() const { return box.sizes().maxCoeff(); }
};

/// A narrow component that reaches from near the ground to a person's height stands by itself; so does one beside the
/// sensor, whose top no plane passed over.
bool likePerson(const Piece& p) { return p.size() <= 1.0f && p.bottom < 0.8f && (p.top > 1.3f || p.open); }

Piece measure(const Cluster& component, const PointCloud& cloud, const GroundModel& ground) {
    Piece p;
    for (const std::int32_t i : component.points) {
        p.box.extend(cloud.xyz[i].head<2>());
        p.bottom = std::min(p.bottom, ground.height[i]);
        p.top = std::max(p.top, ground.height[i]);
        p.open |= cloud.ring[i] + 1 == cloud.view.rings;
        p.planes.set(cloud.ring[i] % kMostPlanes);
    }
    p.like_person = likePerson(p);
    return p;
}

/// What is asked of all pairs of components.
struct Pieces {
    Pieces(const std::vector<Cluster>& c, const PointCloud& scan, const GroundModel& g, const ClusteringParams& p)
        : components(c), cloud(scan), ground(g), params(p), longest(std::hypot(p.join_max_length, p.join_max_width)) {
        for (const Cluster& component : c) piece.push_back(measure(component, scan, g));
    }

    const std::vector<Cluster>& components;
    const PointCloud& cloud;
    const GroundModel& ground;
    const ClusteringParams& params;
    const double longest;  ///< diagonal of what may be joined [m]
    std::vector<Piece> piece;

    const Footprint& footprint(int c) {
        Footprint& f = piece[c].footprint;
        if (f.empty()) f = footprintOf(components[c].points, cloud);
        return f;
    }
};

bool fitsVehicle(const Footprint& a, const Footprint& b, double max_length, double max_width) {
    const double diagonal = a.box.merged(b.box).sizes().norm();
    if (diagonal <= std::min(max_length, max_width)) return true;
    const SmallestRectangle r = smallestRectangle(merged(a, b));
    return r.length <= max_length && r.width <= max_width;
}

/// For each return the component it belongs to, or -1.
std::vector<int> componentOfReturn(const std::vector<Cluster>& components, std::size_t returns) {
    std::vector<int> component(returns, -1);
    for (std::size_t c = 0; c < components.size(); ++c)
        for (const std::int32_t i : components[c].points) component[i] = static_cast<int>(c);
    return component;
}

/// Two components, the smaller number first, that may be pieces of one vehicle.
struct Pair {
    int a = 0;
    int b = 0;
    bool steps = false;  ///< planes step from one to the other

    bool operator<(const Pair& other) const { return a != other.a ? a < other.a : b < other.b; }
    bool operator==(const Pair& other) const { return a == other.a && b == other.b; }
};

/// Pairs where several azimuth columns show one component right above and behind another: the next plane up passes over
/// a hood and hits the windscreen.
std::vector<Pair> pairsBySteps(const Pieces& pieces) {
    constexpr std::ptrdiff_t kMinSteps = 3;
    constexpr float kMaxHood = 1.2f;  // a beam that passes over something higher did not pass over a hood [m]
    const PointCloud& cloud = pieces.cloud;
    const std::vector<int> component = componentOfReturn(pieces.components, cloud.size());
    std::vector<Pair> steps;
    for (int c = 0; c < static_cast<int>(pieces.components.size()); ++c) {
        if (pieces.piece[c].open && pieces.piece[c].top < kMaxHood) continue;  // no plane passed over it
        for (const std::int32_t i : pieces.components[c].points) {
            if (pieces.ground.height[i] > kMaxHood || cloud.ring[i] + 1 >= cloud.view.rings) continue;
            const std::int32_t j = cloud.view.at(cloud.ring[i] + 1, cloud.view.column_of[i]);
            if (j < 0 || component[j] < 0 || component[j] == c) continue;
            const float run = (cloud.xyz[j].head<2>() - cloud.xyz[i].head<2>()).norm();
            if (run <= pieces.params.join_depth)
                steps.push_back({std::min(c, component[j]), std::max(c, component[j]), true});
        }
    }
    std::sort(steps.begin(), steps.end());
    std::vector<Pair> pairs;
    for (auto at = steps.begin(); at != steps.end();) {
        const auto end = std::upper_bound(at, steps.end(), *at);
        if (end - at >= kMinSteps) pairs.push_back(*at);
        at = end;
    }
    return pairs;
}

constexpr std::size_t kFew = 5;    // returns of what cannot stand by itself
constexpr std::size_t kMany = 20;  // returns of what needs no speck from behind something else

/// Are two components near enough to each other, and not both what may be people?
bool mayBelongBeside(const Pieces& pieces, int a, int b) {
    constexpr float kMinPiece = 0.9f;
    const Piece& p = pieces.piece[a];
    const Piece& q = pieces.piece[b];
    if (p.like_person || q.like_person) return false;
    if (p.box.exteriorDistance(q.box) >= pieces.params.join_gap) return false;
    const std::size_t fewer = std::min(pieces.components[a].points.size(), pieces.components[b].points.size());
    if (fewer >= kFew && std::max(p.size(), q.size()) < kMinPiece) return false;
    if (fewer < kFew && (p.planes & q.planes).none()) return false;  // a speck, hit by other planes only
    return p.box.merged(q.box).sizes().maxCoeff() <= pieces.longest;
}

/// Pairs of components beside each other: a sweep along x.
std::vector<Pair> pairsBeside(const Pieces& pieces) {
    std::vector<int> order;
    for (int c = 0; c < static_cast<int>(pieces.components.size()); ++c)
        if (pieces.piece[c].size() <= pieces.longest) order.push_back(c);
    const auto left = [&](int c) { return pieces.piece[c].box.min().x(); };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return left(a) < left(b); });
    std::vector<Pair> pairs;
    for (std::size_t m = 0; m < order.size(); ++m) {
        const double end = pieces.piece[order[m]].box.max().x() + pieces.params.join_gap;
        for (std::size_t n = m + 1; n < order.size() && left(order[n]) < end; ++n)
            if (mayBelongBeside(pieces, order[m], order[n]))
                pairs.push_back({std::min(order[m], order[n]), std::max(order[m], order[n]), false});
    }
    return pairs;
}

/// Does nothing that lies between two components part them?
bool belongTogether(const Pieces& pieces, const Pair& pair, const Gap& gap) {
    const auto [fewer, more] =
        std::minmax({pieces.components[pair.a].points.size(), pieces.components[pair.b].points.size()});
    return nothingBetween({pieces.cloud, pieces.ground}, gap, fewer >= kFew || more < kMany);
}

/// All pairs to be looked at, each once, those by steps first where both apply.
std::vector<Pair> candidatePairs(const Pieces& pieces) {
    std::vector<Pair> pairs = pairsBySteps(pieces);
    const std::vector<Pair> beside = pairsBeside(pieces);
    pairs.insert(pairs.end(), beside.begin(), beside.end());
    std::stable_sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

/// Joins one pair after the other.
class Joiner {
  public:
    explicit Joiner(Pieces& pieces)
        : sets(static_cast<int>(pieces.components.size())), pieces_(pieces), joined_(pieces.components.size()) {}

    void look(const Pair& pair) {
        const int a = std::min(sets.find(pair.a), sets.find(pair.b));
        const int b = std::max(sets.find(pair.a), sets.find(pair.b));
        if (a == b || pieces_.piece[pair.a].like_person || pieces_.piece[pair.b].like_person) return;
        if (pair.steps ? !fits(a, b, pieces_.params.join_max_length) : !belongBeside(pair, a, b)) return;
        joined_[a] = merged(footprint(a), footprint(b));
        sets.join(a, b);
    }

    LabelSets sets;

  private:
    bool belongBeside(const Pair& pair, int a, int b) {
        if (unfit_.count({a, b}) != 0) return false;
        const Gap gap = gapBetween(pieces_.footprint(pair.a), pieces_.footprint(pair.b));
        if (gap.length >= pieces_.params.join_gap) return false;
        if (fits(a, b, pieces_.params.join_gap_length)) return belongTogether(pieces_, pair, gap);
        unfit_.insert({a, b});
        return false;
    }
    bool fits(int a, int b, double max_length) {
        return fitsVehicle(footprint(a), footprint(b), max_length, pieces_.params.join_max_width);
    }
    const Footprint& footprint(int c) { return joined_[c].empty() ? pieces_.footprint(c) : joined_[c]; }

    Pieces& pieces_;
    std::vector<Footprint> joined_;        ///< of what is joined so far
    std::set<std::pair<int, int>> unfit_;  ///< pairs of sets too large together: they only grow
};

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
    Pieces pieces(components, cloud, ground, params);
    Joiner joiner(pieces);
    for (const Pair& pair : candidatePairs(pieces)) joiner.look(pair);
    merge(components, joiner.sets);
    return components;
}

}  // namespace lidar_obstacles
