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

float areaOf(const SmallestRectangle& r) {
    constexpr float kThinnest = 0.2f;  // a line has no area
    return std::max(r.length, kThinnest) * std::max(r.width, kThinnest);
}

/// Returns and the smallest rectangle around them.
struct Piece {
    Returns points;
    SmallestRectangle around;
};

Piece pieceOf(Returns points, const PointCloud& cloud) {
    const SmallestRectangle around = smallestRectangle(footprintOf(points, cloud));
    return {std::move(points), around};
}

/// Is a piece too long, or do its halves leave markedly less empty space?
bool isWorthHalving(const Piece& piece, const Piece& first, const Piece& second) {
    constexpr float kSaved = 0.6f;  // share of the area that two halves may have at most
    return piece.around.length > kLongest ||
           areaOf(first.around) + areaOf(second.around) < kSaved * areaOf(piece.around);
}

/// Halves the returns until each piece is short enough, and does not enclose what is mostly empty.
void cut(Piece piece, const PointCloud& cloud, std::vector<Piece>& pieces) {
    if (piece.around.length > kShortest) {
        Halves halves = halved(piece.points, cloud, piece.around.along);
        const bool both = !halves.first.empty() && !halves.second.empty();
        Piece first = pieceOf(std::move(halves.first), cloud);
        Piece second = pieceOf(std::move(halves.second), cloud);
        if (both && isWorthHalving(piece, first, second)) {
            cut(std::move(first), cloud, pieces);
            cut(std::move(second), cloud, pieces);
            return;
        }
    }
    pieces.push_back(std::move(piece));
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

Obstacle boxAround(Piece piece, const Cluster& cluster, SurfaceTops& topOf) {
    const Returns& points = piece.points;
    const SmallestRectangle& r = piece.around;
    const PointCloud& cloud = topOf.cloud;
    Obstacle o;
    o.cls = cluster.cls;
    o.probability = cluster.probability;
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
    o.points = std::move(piece.points);
    return o;
}

}  // namespace

std::vector<Obstacle> structureBoxes(const Cluster& cluster, SurfaceTops& topOf) {
    std::vector<Obstacle> boxes;
    if (cluster.points.empty()) return boxes;
    std::vector<Piece> pieces;
    cut(pieceOf(cluster.points, topOf.cloud), topOf.cloud, pieces);
    for (Piece& piece : pieces) boxes.push_back(boxAround(std::move(piece), cluster, topOf));
    return boxes;
}

}  // namespace lidar_obstacles
