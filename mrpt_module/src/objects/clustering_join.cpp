#include <algorithm>
#include <bitset>
#include <cmath>
#include <optional>

#include "lidar_obstacles/clustering.h"
#include "objects/footprint.h"
#include "objects/join_gap.h"
#include "scan/label_sets.h"

namespace lidar_obstacles {
namespace {

constexpr std::size_t kMostPlanes = 128;

/// What is known of a component beside its returns.
struct Piece {
    Eigen::AlignedBox2f box;  ///< [m]
    float bottom = 1e9f;      ///< height above the ground [m]
    float top = 0.0f;
    bool open = false;                   ///< the highest plane hit it: its top is not known
    bool like_person = false;            ///< may be one, and stands by itself
    std::bitset<kMostPlanes> planes;     ///< that hit it
    std::optional<Footprint> footprint;  ///< made when first asked for

    float size() const { return box.sizes().maxCoeff(); }
};

/// A narrow component that reaches from near the ground to a person's height stands by itself; so does one beside the
/// sensor, whose top no plane passed over.
bool likePerson(const Piece& p) { return p.size() <= 1.0f && p.bottom < 0.8f && (p.top > 1.3f || p.open); }

Piece measure(const Cluster& component, const PointCloud& cloud, const GroundModel& ground) {
    Piece p;
    p.box = boundsOf(component.points, cloud);
    std::uint16_t highest = 0;
    for (const std::int32_t i : component.points) {
        p.bottom = std::min(p.bottom, ground.height[i]);
        p.top = std::max(p.top, ground.height[i]);
        highest = std::max(highest, cloud.ring[i]);
        p.planes[cloud.ring[i] % kMostPlanes] = true;
    }
    p.open = highest + 1 == cloud.view.rings;
    p.like_person = likePerson(p);
    return p;
}

/// What is asked of all pairs of components.
struct Pieces {
    Pieces(const std::vector<Cluster>& c, const PointCloud& scan, const GroundModel& g, const ClusteringParams& p)
        : components(c), cloud(scan), ground(g), params(p), longest(std::hypot(p.join_max_length, p.join_max_width)) {
        piece.reserve(c.size());
        for (const Cluster& component : c) piece.push_back(measure(component, scan, g));
    }

    const std::vector<Cluster>& components;
    const PointCloud& cloud;
    const GroundModel& ground;
    const ClusteringParams& params;
    const double longest;  ///< diagonal of what may be joined [m]
    std::vector<Piece> piece;

    const Footprint& footprint(int c) {
        std::optional<Footprint>& f = piece[c].footprint;
        if (!f) f = footprintOf(components[c].points, cloud);
        return *f;
    }
};

bool fitsVehicle(const Footprint& a, const Footprint& b, double max_length, double max_width) {
    if (surelyWithin(a.box.merged(b.box).sizes(), max_length, max_width)) return true;
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

    /// Its place in order: by a, then b, those by steps first.
    std::int64_t place() const { return (std::int64_t{a} << 32 | b) * 2 + (steps ? 0 : 1); }
    bool operator<(const Pair& other) const { return place() < other.place(); }
    bool operator==(const Pair& other) const { return a == other.a && b == other.b; }
};

/// Pairs where several azimuth columns show one component right above and behind another: the next plane up passes over
/// a hood and hits the windscreen.
std::vector<Pair> pairsBySteps(const Pieces& pieces) {
    constexpr std::ptrdiff_t kMinSteps = 3;
    constexpr float kMaxHood = 1.2f;  // a beam that passes over something higher did not pass over a hood [m]
    const PointCloud& cloud = pieces.cloud;
    const auto depth = static_cast<float>(pieces.params.join_depth);
    const std::vector<int> component = componentOfReturn(pieces.components, cloud.size());
    std::vector<Pair> steps;
    for (int c = 0; c < static_cast<int>(pieces.components.size()); ++c) {
        if (pieces.piece[c].open && pieces.piece[c].top < kMaxHood) continue;  // no plane passed over it
        for (const std::int32_t i : pieces.components[c].points) {
            if (pieces.ground.height[i] > kMaxHood || cloud.ring[i] + 1 >= cloud.view.rings) continue;
            const std::int32_t j = cloud.view.at(cloud.ring[i] + 1, cloud.view.column_of[i]);
            if (j < 0 || component[j] < 0 || component[j] == c) continue;
            if ((cloud.xyz[j].head<2>() - cloud.xyz[i].head<2>()).squaredNorm() <= depth * depth)
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

/// May two components near each other be pieces of one vehicle, by their sizes, returns and planes?
bool mayBelongBeside(const Pieces& pieces, int a, int b) {
    constexpr float kMinPiece = 0.9f;
    const Piece& p = pieces.piece[a];
    const Piece& q = pieces.piece[b];
    const std::size_t fewer = std::min(pieces.components[a].points.size(), pieces.components[b].points.size());
    if (fewer >= kFew && std::max(p.size(), q.size()) < kMinPiece) return false;
    if (fewer < kFew && (p.planes & q.planes).none()) return false;  // a speck, hit by other planes only
    return p.box.merged(q.box).sizes().maxCoeff() <= pieces.longest;
}

/// Pairs of components beside each other, neither of them like a person: a sweep along x.
std::vector<Pair> pairsBeside(const Pieces& pieces) {
    struct Place {
        Eigen::AlignedBox2f box;
        int component;
    };
    std::vector<Place> places;  // on their own: most pairs are too far apart, and nothing else is asked of them
    for (int c = 0; c < static_cast<int>(pieces.components.size()); ++c)
        if (pieces.piece[c].size() <= pieces.longest && !pieces.piece[c].like_person)
            places.push_back({pieces.piece[c].box, c});
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.box.min().x() < b.box.min().x(); });
    const auto gap = static_cast<float>(pieces.params.join_gap);
    std::vector<Pair> pairs;
    for (auto p = places.begin(); p != places.end(); ++p) {
        for (auto q = p + 1; q != places.end() && q->box.min().x() < p->box.max().x() + gap; ++q) {
            const Eigen::Array2f apart = (q->box.min() - p->box.max()).cwiseMax(p->box.min() - q->box.max());
            if (apart.max(0.0f).square().sum() >= gap * gap) continue;
            const auto [a, b] = std::minmax(p->component, q->component);
            if (mayBelongBeside(pieces, a, b)) pairs.push_back({a, b, false});
        }
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
    std::sort(pairs.begin(), pairs.end());
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
        const Gap gap = gapBetween(pieces_.footprint(pair.a), pieces_.footprint(pair.b));
        if (gap.length >= pieces_.params.join_gap) return false;
        return fits(a, b, pieces_.params.join_gap_length) && belongTogether(pieces_, pair, gap);
    }
    bool fits(int a, int b, double max_length) {
        return fitsVehicle(footprint(a), footprint(b), max_length, pieces_.params.join_max_width);
    }
    const Footprint& footprint(int c) { return joined_[c] ? *joined_[c] : pieces_.footprint(c); }

    Pieces& pieces_;
    std::vector<std::optional<Footprint>> joined_;  ///< of what is joined so far, by its first component
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
