#include <algorithm>
#include <cmath>
#include <map>

#include "lidar_obstacles/clustering.h"
#include "objects/follow_up.h"
#include "objects/footprint.h"
#include "scan/ring_elevations.h"

namespace lidar_obstacles {
namespace {

/// A scan and what is known of it.
struct Seen {
    const PointCloud& cloud;
    const GroundModel& ground;
    RingElevations planes;

    int ring(std::int32_t i) const { return cloud.ring.empty() ? 0 : cloud.ring[i]; }
    float range(std::int32_t i) const { return (cloud.xyz[i] - cloud.sensor_origin).norm(); }
};

/// Did a beam pass below return i and go on behind it? The nearest plane below that brought something back tells: it
/// ended well behind the return, and not in front of it.
bool passedBelow(const Seen& seen, std::int32_t i) {
    constexpr float kBehind = 0.5f;
    const OrganizedView& view = seen.cloud.view;
    const Eigen::Vector2f sensor = seen.cloud.sensor_origin.head<2>();
    for (int ring = seen.ring(i) - 1; ring >= 0; --ring) {
        const std::int32_t j = view.at(ring, view.column_of[i]);
        if (j < 0) continue;
        return (seen.cloud.xyz[j].head<2>() - sensor).norm() > (seen.cloud.xyz[i].head<2>() - sensor).norm() + kBehind;
    }
    return false;
}

/// Does the cluster hang in the air? Only beams that passed below it prove that: through most of its columns. That no
/// plane of the sensor looked lower, or that something nearer stopped the beams, proves nothing.
bool floats(const Seen& seen, const Cluster& cluster) {
    const OrganizedView& view = seen.cloud.view;
    if (view.empty()) return false;
    std::map<std::int32_t, std::int32_t> lowest;  // return of each column
    for (const std::int32_t i : cluster.points) {
        const auto [it, added] = lowest.emplace(view.column_of[i], i);
        if (!added && seen.ring(i) < seen.ring(it->second)) it->second = i;
    }
    const auto passed =
        std::count_if(lowest.begin(), lowest.end(), [&](const auto& c) { return passedBelow(seen, c.second); });
    return 2 * static_cast<std::size_t>(passed) > lowest.size();
}

/// How high the obstacle may be: where the next plane passed above its returns [m].
float highestTop(const Seen& seen, const Cluster& cluster) {
    float top = -1e9f;
    for (const std::int32_t i : cluster.points) {
        const float step = seen.planes.stepUp(seen.ring(i)) * seen.range(i);
        top = std::max(top, seen.ground.height[i] + step);
    }
    return top;
}

/// Heights of a cluster and whether it hangs in the air, with beams seen to pass below it.
bool overhangs(const Seen& seen, const Cluster& c, const GateParams& params) {
    return c.bottom > params.max_bottom && floats(seen, c);
}

bool reject(RejectedCluster& r, RejectReason reason, double measured, double limit) {
    r.reason = reason;
    r.measured = measured;
    r.limit = limit;
    return true;
}

/// Is what a box with these sides holds surely neither too large, nor too small, nor a pole, and need not be measured?
bool surelyOfVehicleSize(const Eigen::Vector2f& sides, const GateParams& params) {
    constexpr double kDiagonal = 1.415;  // a rectangle's longer side is its diagonal / sqrt(2) at least
    return surelyWithin(sides, params.max_length, params.max_width) &&
           sides.maxCoeff() >= kDiagonal * std::max(params.min_extent, params.pole_width);
}

bool rejected(RejectedCluster& r, const Seen& seen, const GateParams& params) {
    const Cluster& c = r.cluster;
    const auto points = static_cast<double>(c.points.size());
    if (points < params.min_points) return reject(r, RejectReason::TooFewPoints, points, params.min_points);
    if (c.top < params.min_top) {
        const float top = highestTop(seen, c);
        if (top < params.min_top) return reject(r, RejectReason::TooLow, top, params.min_top);
    }
    if (overhangs(seen, c, params)) return reject(r, RejectReason::Floating, c.bottom, params.max_bottom);
    const Eigen::Vector2f sides = boundsOf(c.points, seen.cloud).sizes();
    const bool too_tall = c.top > params.max_top;
    if (!too_tall && surelyOfVehicleSize(sides, params)) return false;
    const SmallestRectangle size = smallestRectangle(footprintOf(c.points, seen.cloud));
    const double length = size.length;
    const double width = size.width;
    if (length > params.max_length) return reject(r, RejectReason::TooLarge, length, params.max_length);
    if (width > params.max_width) return reject(r, RejectReason::TooLarge, width, params.max_width);
    if (length < params.min_extent) return reject(r, RejectReason::TooSmall, length, params.min_extent);
    if (too_tall) return reject(r, RejectReason::TooTall, c.top, params.max_top);
    if (c.top > params.pole_top && length < params.pole_width)
        return reject(r, RejectReason::Pole, c.top, params.pole_top);
    return false;
}

/// Is what was rejected for this reason there all the same, only no road user?
bool stands(RejectReason reason) {
    return reason == RejectReason::TooLarge || reason == RejectReason::TooTall || reason == RejectReason::Pole ||
           reason == RejectReason::TooSmall;
}

void measureHeights(SurfaceTops& topOf, Cluster& cluster) {
    constexpr float kFollowFrom = 1.5f;  // lower surfaces are not followed: what is above them is known
    constexpr std::size_t kMaxFollowed = 64;
    const std::size_t stride = 1 + cluster.points.size() / kMaxFollowed;
    cluster.bottom = 1e9f;
    cluster.top = -1e9f;
    for (std::size_t k = 0; k < cluster.points.size(); ++k) {
        const std::int32_t i = cluster.points[k];
        const float height = topOf.ground.height[i];
        cluster.bottom = std::min(cluster.bottom, height);
        const bool follow = k % stride == 0 && height > kFollowFrom && !topOf.cloud.view.empty();
        cluster.top = std::max(cluster.top, follow ? topOf(i) : height);
    }
}

}  // namespace

std::vector<Cluster> withoutOverhangs(std::vector<Cluster> pieces, SurfaceTops& topOf, const GateParams& params,
                                      std::vector<RejectedCluster>& rejected) {
    const Seen seen{topOf.cloud, topOf.ground, RingElevations(topOf.cloud)};
    std::vector<Cluster> kept;
    kept.reserve(pieces.size());
    for (Cluster& piece : pieces) {
        piece.bottom = 1e9f;
        for (const std::int32_t i : piece.points) piece.bottom = std::min(piece.bottom, topOf.ground.height[i]);
        if (overhangs(seen, piece, params))
            rejected.push_back({std::move(piece), RejectReason::Floating, piece.bottom, params.max_bottom});
        else
            kept.push_back(std::move(piece));
    }
    return kept;
}

Clusters sortGroups(std::vector<Hypothesis>& tree, SurfaceTops& topOf, const GateParams& params) {
    const Seen seen{topOf.cloud, topOf.ground, RingElevations(topOf.cloud)};
    Clusters out;
    for (const Hypothesis& h : tree) {
        if (!h.chosen) continue;
        Cluster c;
        c.points = h.points;
        c.probability = h.probability;
        c.cls = static_cast<ObstacleClass>(std::max_element(h.probability.begin(), h.probability.end()) -
                                           h.probability.begin());
        measureHeights(topOf, c);
        c.max_top = std::max(c.top, highestTop(seen, c));
        const auto points = static_cast<double>(c.points.size());
        if (points < params.min_points)
            out.rejected.push_back(
                {std::move(c), RejectReason::TooFewPoints, points, static_cast<double>(params.min_points)});
        else if (c.max_top < params.min_top)
            out.rejected.push_back({std::move(c), RejectReason::TooLow, c.max_top, params.min_top});
        else
            (c.cls == ObstacleClass::Structure ? out.structure : out.accepted).push_back(std::move(c));
    }
    return out;
}

Clusters gateBySize(std::vector<Cluster> components, SurfaceTops& topOf, const GateParams& params) {
    Clusters out;
    for (Cluster& c : components) {
        RejectedCluster r;
        const SmallestRectangle size = smallestRectangle(footprintOf(c.points, topOf.cloud));
        const auto points = static_cast<double>(c.points.size());
        measureHeights(topOf, c);
        c.max_top = c.top;
        r.cluster = std::move(c);
        if (points < params.min_points)
            reject(r, RejectReason::TooFewPoints, points, params.min_points);
        else if (size.length < params.min_extent)
            reject(r, RejectReason::TooSmall, size.length, params.min_extent);
        else if (size.length > params.max_length || size.width > params.max_width)
            reject(r, RejectReason::TooLarge, size.length, params.max_length);
        else {
            out.accepted.push_back(std::move(r.cluster));
            continue;
        }
        out.rejected.push_back(std::move(r));
    }
    return out;
}

Clusters gateClusters(const PointCloud& cloud, const GroundModel& ground, std::vector<Cluster> components,
                      const GateParams& params) {
    SurfaceTops topOf(cloud, ground);
    return gateClusters(std::move(components), topOf, params);
}

Clusters gateClusters(std::vector<Cluster> components, SurfaceTops& topOf, const GateParams& params) {
    const Seen seen{topOf.cloud, topOf.ground, RingElevations(topOf.cloud)};
    Clusters out;
    for (Cluster& c : components) {
        if (static_cast<int>(c.points.size()) >= params.min_points) measureHeights(topOf, c);
        RejectedCluster r;
        r.cluster = std::move(c);
        if (rejected(r, seen, params)) {
            if (stands(r.reason))
                out.structure.push_back(std::move(r.cluster));
            else
                out.rejected.push_back(std::move(r));
        } else {
            r.cluster.max_top = std::max(r.cluster.top, highestTop(seen, r.cluster));
            out.accepted.push_back(std::move(r.cluster));
        }
    }
    return out;
}

}  // namespace lidar_obstacles
