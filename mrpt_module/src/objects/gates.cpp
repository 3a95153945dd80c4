#include <algorithm>
#include <cmath>

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

/// Does something nearer end the beam of the next plane below return i that hit anything?
bool hiddenBelow(const Seen& seen, std::int32_t i) {
    constexpr float kNearer = 0.5f;
    const OrganizedView& view = seen.cloud.view;
    for (int ring = seen.ring(i) - 1; ring >= 0; --ring) {
        const std::int32_t j = view.at(ring, view.column_of[i]);
        if (j >= 0) return !seen.ground.is_ground[j] && seen.range(j) < seen.range(i) - kNearer;
    }
    return false;
}

/// Is it open whether the cluster reaches down to the ground? A low one, because nearer obstacles hide what is below
/// its lowest returns; any, because no plane passed below them higher than a vehicle's belly.
bool mayStand(const Seen& seen, const Cluster& cluster, const GateParams& params) {
    constexpr float kLowest = 0.2f;  // returns this near to the bottom are looked at [m]
    constexpr float kBelly = 0.3f;
    if (seen.cloud.view.empty()) return false;
    const bool low = cluster.top < params.hidden_top;
    int open = 0;
    int looked_at = 0;
    for (const std::int32_t i : cluster.points) {
        const float height = seen.ground.height[i];
        if (height > cluster.bottom + kLowest) continue;
        ++looked_at;
        const float passed = height - seen.planes.stepDown(seen.ring(i)) * seen.range(i);
        open += passed < kBelly || (low && hiddenBelow(seen, i));
    }
    return 2 * open > looked_at;
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
    if (c.bottom > params.max_bottom && !mayStand(seen, c, params))
        return reject(r, RejectReason::Floating, c.bottom, params.max_bottom);
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
        if (rejected(r, seen, params))
            out.rejected.push_back(std::move(r));
        else {
            r.cluster.max_top = std::max(r.cluster.top, highestTop(seen, r.cluster));
            out.accepted.push_back(std::move(r.cluster));
        }
    }
    return out;
}

}  // namespace lidar_obstacles
