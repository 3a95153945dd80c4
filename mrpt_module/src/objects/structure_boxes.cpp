#include "objects/structure_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "objects/box.h"
#include "objects/footprint.h"

namespace lidar_obstacles {
namespace {

using Returns = std::vector<std::int32_t>;

constexpr float kLongest = 6.0f;   // of a piece [m]
constexpr float kShortest = 1.5f;  // what is shorter follows whatever it is [m]

struct Halves {
    Returns first;
    Returns second;
};

/// The returns on either side of the middle of the longer side.
Halves halved(const Returns& points, const PointCloud& cloud, const Eigen::Vector2f& along) {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (const std::int32_t i : points) {
        const float at = along.dot(cloud.xyz[i].head<2>());
        low = std::min(low, at);
        high = std::max(high, at);
    }
    Halves halves;
    for (const std::int32_t i : points)
        (along.dot(cloud.xyz[i].head<2>()) < 0.5f * (low + high) ? halves.first : halves.second).push_back(i);
    return halves;
}

float areaOf(const Returns& points, const PointCloud& cloud) {
    constexpr float kThinnest = 0.2f;  // a line has no area
    const SmallestRectangle r = smallestRectangle(footprintOf(points, cloud));
    return std::max(r.length, kThinnest) * std::max(r.width, kThinnest);
}

/// Halves the returns until each piece is short enough, and does not enclose what is mostly empty.
void cut(Returns points, const PointCloud& cloud, std::vector<Returns>& pieces) {
    constexpr float kSaved = 0.6f;  // share of the area that two halves may have at most
    const SmallestRectangle r = smallestRectangle(footprintOf(points, cloud));
    if (r.length > kShortest) {
        Halves halves = halved(points, cloud, r.along);
        const bool worth = r.length > kLongest ||
                           areaOf(halves.first, cloud) + areaOf(halves.second, cloud) < kSaved * areaOf(points, cloud);
        if (worth && !halves.first.empty() && !halves.second.empty()) {
            cut(std::move(halves.first), cloud, pieces);
            cut(std::move(halves.second), cloud, pieces);
            return;
        }
    }
    pieces.push_back(std::move(points));
}

/// The piece stands on the ground, unless nothing of it was seen as low as a vehicle: then it is what was seen.
void setHeights(const Returns& points, SurfaceTops& topOf, Obstacle& o) {
    constexpr float kVehicle = 2.5f;  // [m]
    constexpr float kLowest = 0.1f;   // height of a box [m]
    float top = kLowest;
    float bottom = std::numeric_limits<float>::max();
    for (const std::int32_t i : points) {
        top = std::max(top, topOf.cloud.view.empty() ? topOf.ground.height[i] : topOf(i));
        bottom = std::min(bottom, topOf.ground.height[i]);
    }
    if (bottom < kVehicle) bottom = 0.0f;
    const double ground = topOf.ground.heightAt(o.box.center.x(), o.box.center.y());
    o.box.size.z() = std::max(top - bottom, kLowest);
    o.box.center.z() = ground + bottom + 0.5 * o.box.size.z();
    o.max_height = o.box.size.z();
}

Obstacle boxAround(Returns points, const Cluster& cluster, SurfaceTops& topOf) {
    const PointCloud& cloud = topOf.cloud;
    Obstacle o;
    o.cls = cluster.cls;
    o.probability = cluster.probability;
    const SmallestRectangle r = smallestRectangle(footprintOf(points, cloud));
    const Eigen::Vector2f across(-r.along.y(), r.along.x());
    Eigen::AlignedBox2f box;
    for (const std::int32_t i : points) {
        const Eigen::Vector2f p = cloud.xyz[i].head<2>();
        box.extend(Eigen::Vector2f(r.along.dot(p), across.dot(p)));
    }
    const Eigen::Vector2f center = box.center();
    o.box.center.head<2>() = (center.x() * r.along + center.y() * across).cast<double>();
    o.box.size.head<2>() = box.sizes().cwiseMax(0.05f).cast<double>();
    o.box.yaw = normalizeAngle(std::atan2(r.along.y(), r.along.x()));
    setHeights(points, topOf, o);
    o.seen_box = o.box;
    o.num_points = static_cast<int>(points.size());
    o.num_rings = countPlanes(points, cloud);
    o.points = std::move(points);
    return o;
}

}  // namespace

std::vector<Obstacle> structureBoxes(const Cluster& cluster, SurfaceTops& topOf) {
    std::vector<Obstacle> boxes;
    if (cluster.points.empty()) return boxes;
    std::vector<Returns> pieces;
    cut(cluster.points, topOf.cloud, pieces);
    for (Returns& piece : pieces) boxes.push_back(boxAround(std::move(piece), cluster, topOf));
    return boxes;
}

}  // namespace lidar_obstacles
