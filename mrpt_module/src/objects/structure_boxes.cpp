// SPDX-License-Identifier: BSD-3-Clause
#include "objects/structure_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lidar_obstacles/classification.h"
#include "objects/box.h"
#include "objects/footprint.h"

namespace lidar_obstacles {
namespace {

using Returns = std::vector<std::int32_t>;

constexpr float kShortest = 1.5f;  // what is shorter follows whatever it is [m]

float areaOf(const SmallestRectangle& r) {
    constexpr float kThinnest = 0.2f;  // a line has no area
    return std::max(r.length, kThinnest) * std::max(r.width, kThinnest);
}

/// Returns that lie side by side in a cutter's list, and the smallest rectangle around them.
struct Piece {
    std::size_t first = 0;
    std::size_t end = 0;
    SmallestRectangle around;
};

/// Is a piece too long, or do its halves leave markedly less empty space?
bool isWorthHalving(const Piece& piece, const Piece& first, const Piece& second) {
    constexpr float kSaved = 0.6f;  // share of the area that two halves may have at most
    return piece.around.length > kLongestStructureBox ||
           areaOf(first.around) + areaOf(second.around) < kSaved * areaOf(piece.around);
}

/// Halves returns until each piece is short enough, and does not enclose what is mostly empty.
class Cutter {
  public:
    explicit Cutter(const PointCloud& cloud) : cloud_(cloud) {}

    /// The pieces of some returns. Keeps its memory from one to the next.
    const std::vector<Piece>& piecesOf(const Returns& points) {
        points_ = points;
        halves_.resize(points.size());
        places_.resize(points.size());
        pieces_.clear();
        cut({0, points.size(), around(points_, 0, points.size())});
        return pieces_;
    }
    /// The returns of a piece.
    Returns returnsOf(const Piece& piece) const {
        const auto begin = points_.begin();
        return {begin + static_cast<std::ptrdiff_t>(piece.first), begin + static_cast<std::ptrdiff_t>(piece.end)};
    }

  private:
    SmallestRectangle around(const Returns& points, std::size_t first, std::size_t end) const {
        return smallestRectangle(footprintOf(points.data() + first, end - first, cloud_));
    }

    /// Puts the returns on either side of the middle of the longer side into halves_. @return where the second begins.
    std::size_t halve(const Piece& piece) {
        const Eigen::Vector2f& along = piece.around.along;
        float low = std::numeric_limits<float>::max();
        float high = std::numeric_limits<float>::lowest();
        for (std::size_t k = piece.first; k < piece.end; ++k) {
            places_[k] = along.dot(cloud_.xyz[points_[k]].head<2>());
            low = std::min(low, places_[k]);
            high = std::max(high, places_[k]);
        }
        const float middle = 0.5f * (low + high);
        std::size_t middle_at = piece.first;
        for (std::size_t k = piece.first; k < piece.end; ++k)
            middle_at += static_cast<std::size_t>(places_[k] < middle);
        std::array<std::size_t, 2> next{middle_at, piece.first};
        for (std::size_t k = piece.first; k < piece.end; ++k)
            halves_[next[static_cast<std::size_t>(places_[k] < middle)]++] = points_[k];
        return middle_at;
    }

    void cut(const Piece& piece) {
        if (piece.around.length > kShortest) {
            const std::size_t middle = halve(piece);
            const Piece first{piece.first, middle, around(halves_, piece.first, middle)};
            const Piece second{middle, piece.end, around(halves_, middle, piece.end)};
            const bool both = middle > piece.first && middle < piece.end;
            if (both && isWorthHalving(piece, first, second)) {
                std::copy_n(halves_.begin() + static_cast<std::ptrdiff_t>(piece.first), piece.end - piece.first,
                            points_.begin() + static_cast<std::ptrdiff_t>(piece.first));
                cut(first);
                cut(second);
                return;
            }
        }
        pieces_.push_back(piece);
    }

    const PointCloud& cloud_;
    Returns points_;
    Returns halves_;
    std::vector<float> places_;  ///< along the piece that is halved [m]
    std::vector<Piece> pieces_;
};

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

Obstacle boxAround(Returns points, const SmallestRectangle& r, const Cluster& cluster, SurfaceTops& topOf) {
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
    const Eigen::Vector2d along = r.along.cast<double>();  // the C library's atan2 of floats differs between releases
    o.box.yaw = normalizeAngle(std::atan2(along.y(), along.x()));
    setHeights(points, topOf, o);
    o.seen_box = o.box;
    o.num_points = static_cast<int>(points.size());
    o.num_rings = countRings(points, cloud);
    o.points = std::move(points);
    return o;
}

/// Are nearly all of these returns in this box of a road user, above that share of its height? Most are far from it, as
/// the first tells.
bool arePart(const Returns& points, double above, const OrientedBox& box, const PointCloud& cloud) {
    constexpr double kRough = 0.15;  // no box fits its body better [m]
    const auto from_center = [&](std::int32_t i) { return Eigen::Vector3d(cloud.xyz[i].cast<double>() - box.center); };
    const double reach = kLongestStructureBox + 0.5 * box.size.norm() + kRough;
    if (from_center(points.front()).norm() > reach) return false;
    const Eigen::Vector2d along = axisOf(box, 0), across = axisOf(box, 1);
    const Eigen::Vector3d half = 0.5 * box.size.array() + kRough;
    const auto outside = std::count_if(points.begin(), points.end(), [&](std::int32_t i) {
        const Eigen::Vector3d d = from_center(i);
        return d.z() < (above - 0.5) * box.size.z() || d.z() > half.z() ||
               std::abs(d.head<2>().dot(along)) > half.x() || std::abs(d.head<2>().dot(across)) > half.y();
    });
    return 10 * outside <= static_cast<std::ptrdiff_t>(points.size());
}

}  // namespace

void addStructureBoxes(const std::vector<Cluster>& clusters, SurfaceTops& topOf, std::vector<Obstacle>& boxes) {
    Cutter cutter(topOf.cloud);
    const auto others = static_cast<std::ptrdiff_t>(boxes.size());
    const auto isOfAnother = [&](const Returns& returns, double above) {
        return std::any_of(boxes.begin(), boxes.begin() + others, [&](const Obstacle& o) {
            return isRoadUser(o.cls) && arePart(returns, above, o.box, topOf.cloud);
        });
    };
    for (const Cluster& cluster : clusters) {
        if (cluster.points.empty()) continue;
        const double above = cluster.cls == ObstacleClass::Unknown ? 0.0 : 0.5;
        for (const Piece& piece : cutter.piecesOf(cluster.points)) {
            Returns returns = cutter.returnsOf(piece);
            if (isOfAnother(returns, above)) continue;
            boxes.push_back(boxAround(std::move(returns), piece.around, cluster, topOf));
        }
    }
}

std::vector<Obstacle> structureBoxes(const Cluster& cluster, SurfaceTops& topOf) {
    std::vector<Obstacle> boxes;
    addStructureBoxes({cluster}, topOf, boxes);
    return boxes;
}

}  // namespace lidar_obstacles
