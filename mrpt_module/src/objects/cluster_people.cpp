#include <algorithm>
#include <utility>

#include "lidar_obstacles/clustering.h"
#include "objects/footprint.h"

namespace lidar_obstacles {
namespace {

constexpr std::size_t kMinReturns = 5;
constexpr float kMinTop = 0.9f;  // people reach higher, children too [m]
constexpr float kMaxTwo = 1.6f;  // two of them side by side; a rear is wider [m]

/// Could it be two people side by side, by its size?
bool twoWide(const SmallestRectangle& r) { return r.length > 0.7f && r.length < kMaxTwo && r.width < 1.0f; }

/// The returns on either side of the widest gap along an axis, if it is wider than what lies between neighbouring
/// beams.
std::pair<Cluster, Cluster> partAtGap(const Cluster& cluster, const PointCloud& cloud, const Eigen::Vector2f& axis) {
    constexpr float kMinGap = 0.2f;
    constexpr float kBeams = 0.0105f;  // three steps of 0.2 deg
    std::vector<std::pair<float, std::int32_t>> along;
    along.reserve(cluster.points.size());
    for (const std::int32_t i : cluster.points) along.emplace_back(axis.dot(cloud.xyz[i].head<2>()), i);
    std::sort(along.begin(), along.end());
    std::size_t at = 0;
    float widest = 0.0f;
    for (std::size_t k = 1; k < along.size(); ++k) {
        const float gap = along[k].first - along[k - 1].first;
        if (gap <= widest) continue;
        widest = gap;
        at = k;
    }
    std::pair<Cluster, Cluster> parts;
    const float range = (cloud.xyz[cluster.points[0]] - cloud.sensor_origin).norm();
    if (widest < std::max(kMinGap, kBeams * range)) return parts;
    parts.first.points.reserve(at);
    parts.second.points.reserve(along.size() - at);
    for (std::size_t k = 0; k < along.size(); ++k)
        (k < at ? parts.first : parts.second).points.push_back(along[k].second);
    return parts;
}

bool likePerson(const Cluster& part, const PointCloud& cloud, const GroundModel& ground) {
    constexpr float kMaxSize = 1.0f;
    if (part.points.size() < kMinReturns) return false;
    const bool upright =
        std::any_of(part.points.begin(), part.points.end(), [&](std::int32_t i) { return ground.height[i] > kMinTop; });
    return upright && boundsOf(part.points, cloud).sizes().maxCoeff() < kMaxSize;
}

/// Enough returns for two, and as high as one of them.
bool mayBeTwo(const Cluster& cluster, const PointCloud& cloud, const GroundModel& ground) {
    constexpr float kGrownUp = 1.2f;  // [m]
    if (cluster.points.size() < 2 * kMinReturns) return false;
    const bool high = std::any_of(cluster.points.begin(), cluster.points.end(),
                                  [&](std::int32_t i) { return ground.height[i] > kGrownUp; });
    return high && boundsOf(cluster.points, cloud).sizes().maxCoeff() <= kMaxTwo;
}

}  // namespace

std::vector<Cluster> splitPeople(std::vector<Cluster> components, const PointCloud& cloud, const GroundModel& ground) {
    const std::size_t count = components.size();
    for (std::size_t c = 0; c < count; ++c) {
        if (!mayBeTwo(components[c], cloud, ground)) continue;
        const SmallestRectangle r = smallestRectangle(footprintOf(components[c].points, cloud));
        if (!twoWide(r)) continue;
        auto [left, right] = partAtGap(components[c], cloud, r.along);
        if (!likePerson(left, cloud, ground) || !likePerson(right, cloud, ground)) continue;
        components[c] = std::move(left);
        components.push_back(std::move(right));
    }
    return components;
}

}  // namespace lidar_obstacles
