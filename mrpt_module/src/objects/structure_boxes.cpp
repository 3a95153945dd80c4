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

/// A piece in two.
struct Cut {
    Piece first;
    Piece second;
    float area = std::numeric_limits<float>::max();  ///< of both [m^2]
};

/// Cuts returns until each piece is short enough, and does not enclose what is mostly empty.
class Cutter {
  public:
    explicit Cutter(const PointCloud& cloud) : cloud_(cloud) {}

    /// The pieces of some returns. Keeps its memory from one to the next.
    const std::vector<Piece>& piecesOf(const Returns& points) {
        points_ = points;
        slice_.resize(points.size());
        for (Returns& s : sliced_) s.resize(points.size());
        pieces_.clear();
        const Footprint all = footprintOf(points, cloud_);
        cut({0, points.size(), smallestRectangle(all)});
        return pieces_;
    }
    /// The returns of a piece.
    Returns returnsOf(const Piece& piece) const {
        const auto begin = points_.begin();
        return {begin + static_cast<std::ptrdiff_t>(piece.first), begin + static_cast<std::ptrdiff_t>(piece.end)};
    }

  private:
    static constexpr std::size_t kSlices = 8;
    using Bounds = std::array<std::size_t, kSlices + 1>;  ///< first places of the slices, and the end of the last

    /// Puts the returns of a piece into a list, slice by slice along a direction.
    Bounds slice(const Piece& piece, const Eigen::Vector2f& along, Returns& sliced) {
        const auto place = [&](std::size_t k) { return along.dot(cloud_.xyz[points_[k]].head<2>()); };
        float low = std::numeric_limits<float>::max();
        float high = std::numeric_limits<float>::lowest();
        for (std::size_t k = piece.first; k < piece.end; ++k) {
            low = std::min(low, place(k));
            high = std::max(high, place(k));
        }
        const float slices_per_metre = kSlices / std::max(high - low, 1e-3f);
        Bounds next{};
        for (std::size_t k = piece.first; k < piece.end; ++k) {
            slice_[k] = std::min(static_cast<int>(kSlices) - 1, static_cast<int>((place(k) - low) * slices_per_metre));
            ++next[static_cast<std::size_t>(slice_[k]) + 1];
        }
        next[0] = piece.first;
        for (std::size_t s = 1; s <= kSlices; ++s) next[s] += next[s - 1];
        const Bounds bounds = next;
        for (std::size_t k = piece.first; k < piece.end; ++k)
            sliced[next[static_cast<std::size_t>(slice_[k])]++] = points_[k];
        return bounds;
    }

    /// The two pieces of least area between two slices, or those of the middle.
    Cut cutOf(const Returns& sliced, const Bounds& bounds, bool in_the_middle) const {
        std::array<Footprint, kSlices> slices, to_the_end;
        for (std::size_t s = 0; s < kSlices; ++s)
            slices[s] = footprintOf(sliced.data() + bounds[s], bounds[s + 1] - bounds[s], cloud_);
        to_the_end = slices;
        for (std::size_t s = kSlices - 1; s-- > 0;) to_the_end[s] = merged(slices[s], to_the_end[s + 1]);
        Cut best;
        Footprint before = slices[0];
        for (std::size_t s = 1; s < kSlices; ++s, before = merged(before, slices[s - 1])) {
            if (before.empty() || to_the_end[s].empty() || (in_the_middle && s != kSlices / 2)) continue;
            const Piece first{bounds[0], bounds[s], smallestRectangle(before)};
            const Piece second{bounds[s], bounds[kSlices], smallestRectangle(to_the_end[s])};
            const float area = areaOf(first.around) + areaOf(second.around);
            if (area < best.area) best = {first, second, area};
        }
        return best;
    }

    void cut(const Piece& piece) {
        constexpr float kSaved = 0.7f;  // share of the area that two pieces of it may have at most
        const Eigen::Vector2f& along = piece.around.along;
        if (piece.around.length <= kShortest) return pieces_.push_back(piece);
        const Bounds lengthwise = slice(piece, along, sliced_[0]);
        Cut best = cutOf(sliced_[0], lengthwise, false);
        std::size_t of = 0;
        if (piece.around.width > kShortest) {
            const Bounds bounds = slice(piece, {-along.y(), along.x()}, sliced_[1]);
            const Cut across = cutOf(sliced_[1], bounds, false);
            of = across.area < best.area ? 1 : 0;
            if (of == 1) best = across;
        }
        if (best.area >= kSaved * areaOf(piece.around)) {
            if (piece.around.length <= kLongestStructureBox) return pieces_.push_back(piece);
            best = cutOf(sliced_[0], lengthwise, true);
            of = 0;
        }
        const auto first = static_cast<std::ptrdiff_t>(piece.first);
        std::copy_n(sliced_[of].begin() + first, piece.end - piece.first, points_.begin() + first);
        cut(best.first);
        cut(best.second);
    }

    const PointCloud& cloud_;
    Returns points_;
    std::array<Returns, 2> sliced_;  ///< the returns of the piece that is cut, by slices along and across it
    std::vector<int> slice_;         ///< of each return of the piece that is cut
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
