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

float areaOf(const Eigen::Vector2f& sides) {
    constexpr float kThinnest = 0.2f;  // a line has no area
    return sides.cwiseMax(kThinnest).prod();
}

float areaOf(const SmallestRectangle& r) { return areaOf(Eigen::Vector2f(r.length, r.width)); }

/// Returns that lie side by side in a cutter's list, and the smallest rectangle around them.
struct Piece {
    std::size_t first = 0;
    std::size_t end = 0;
    SmallestRectangle around;
};

/// Where a piece is cut in two.
struct CutPlace {
    int side = 0;                                    ///< across its longer side (0) or its shorter one (1)
    float at = 0.0f;                                 ///< place along that side [m]
    float area = std::numeric_limits<float>::max();  ///< of what it leaves on either side, along the piece [m^2]
};

/// Cuts returns until each piece is short enough, and does not enclose what is mostly empty.
class Cutter {
  public:
    explicit Cutter(const PointCloud& cloud) : cloud_(cloud) {}

    /// The pieces of some returns. Keeps its memory from one to the next.
    const std::vector<Piece>& piecesOf(const Returns& points) {
        points_ = points;
        second_.resize(points.size());
        pieces_.clear();
        cut({0, points.size(), around(0, points.size())});
        return pieces_;
    }
    /// The returns of a piece.
    Returns returnsOf(const Piece& piece) const {
        const auto begin = points_.begin();
        return {begin + static_cast<std::ptrdiff_t>(piece.first), begin + static_cast<std::ptrdiff_t>(piece.end)};
    }

  private:
    using Box = Eigen::AlignedBox2f;  ///< along the longer and the shorter side of a piece
    static constexpr int kSlices = 8;
    using Slices = std::array<Box, kSlices>;

    SmallestRectangle around(std::size_t first, std::size_t end) const {
        return smallestRectangle(footprintOf(points_.data() + first, end - first, cloud_));
    }

    /// A return's place along the longer and the shorter side.
    Eigen::Vector2f placeOf(std::size_t k, const Piece& piece) const {
        const Eigen::Vector2f p = cloud_.xyz[points_[k]].head<2>();
        const Eigen::Vector2f& along = piece.around.along;
        return {along.dot(p), along.x() * p.y() - along.y() * p.x()};
    }

    /// The cut between two slices across a side that leaves the least area, or the one in the middle.
    static CutPlace cutOf(const Slices& slices, const Box& all, int side, bool in_the_middle) {
        Slices to_the_end = slices;
        for (int s = kSlices - 1; s-- > 0;) to_the_end[s].extend(to_the_end[s + 1]);
        CutPlace best;
        Box before;
        for (int s = 1; s < kSlices; ++s) {
            before.extend(slices[s - 1]);
            if (in_the_middle && s != kSlices / 2) continue;
            const float area = areaOf(before.sizes()) + areaOf(to_the_end[s].sizes());
            const float at = all.min()[side] + all.sizes()[side] * static_cast<float>(s) / kSlices;
            if (area < best.area) best = {side, at, area};
        }
        return best;
    }

    /// The best cut of a piece, and the one in the middle of its longer side.
    std::array<CutPlace, 2> cutsOf(const Piece& piece) const {
        Box all;
        for (std::size_t k = piece.first; k < piece.end; ++k) all.extend(placeOf(k, piece));
        const Eigen::Array2f slices_per_metre = kSlices / all.sizes().array().max(1e-3f);
        std::array<Slices, 2> slices;
        for (std::size_t k = piece.first; k < piece.end; ++k) {
            const Eigen::Vector2f p = placeOf(k, piece);
            const Eigen::Array2i slice = ((p - all.min()).array() * slices_per_metre).cast<int>().min(kSlices - 1);
            for (int side = 0; side < 2; ++side)
                slices[static_cast<std::size_t>(side)][static_cast<std::size_t>(slice[side])].extend(p);
        }
        CutPlace best = cutOf(slices[0], all, 0, false);
        if (piece.around.width > kShortest)
            if (const CutPlace across = cutOf(slices[1], all, 1, false); across.area < best.area) best = across;
        return {best, cutOf(slices[0], all, 0, true)};
    }

    /// Puts the returns of a piece on either side of a cut together. @return the two.
    std::array<Piece, 2> halvesOf(const Piece& piece, const CutPlace& cut) {
        std::size_t middle = piece.first;
        std::size_t second = 0;
        for (std::size_t k = piece.first; k < piece.end; ++k) {
            const std::int32_t i = points_[k];
            if (placeOf(k, piece)[cut.side] < cut.at)
                points_[middle++] = i;
            else
                second_[second++] = i;
        }
        std::copy_n(second_.begin(), second, points_.begin() + static_cast<std::ptrdiff_t>(middle));
        return {Piece{piece.first, middle, around(piece.first, middle)},
                {middle, piece.end, around(middle, piece.end)}};
    }

    /// Do its halves leave markedly less empty space? At the last cut it is enough that the piece is too long.
    static bool isWorthCutting(const Piece& piece, const std::array<Piece, 2>& halves, bool last) {
        constexpr float kSaved = 0.7f;  // share of the area that two pieces of it may have at most
        if (halves[0].first == halves[0].end || halves[1].first == halves[1].end) return false;
        return areaOf(halves[0].around) + areaOf(halves[1].around) < kSaved * areaOf(piece.around) ||
               (last && piece.around.length > kLongestStructureBox);
    }

    void cut(const Piece& piece) {
        if (piece.around.length > kShortest) {
            const std::array<CutPlace, 2> cuts = cutsOf(piece);
            for (const CutPlace& c : cuts) {
                const std::array<Piece, 2> halves = halvesOf(piece, c);
                if (!isWorthCutting(piece, halves, &c == &cuts.back())) continue;
                for (const Piece& half : halves) cut(half);
                return;
            }
        }
        pieces_.push_back(piece);
    }

    const PointCloud& cloud_;
    Returns points_;
    Returns second_;  ///< the returns beyond a cut
    std::vector<Piece> pieces_;
};

/// The piece stands on the ground, unless it hangs or nothing of it was seen as low as a vehicle: then it is what was
/// seen.
void setHeights(const Returns& points, SurfaceTops& topOf, bool hangs, Obstacle& o) {
    constexpr float kVehicle = 2.5f;  // [m]
    constexpr float kLowest = 0.1f;   // height of a box [m]
    float top = kLowest;
    float bottom = std::numeric_limits<float>::max();
    for (const std::int32_t i : points) {
        top = std::max(top, topOf.cloud.view.empty() ? topOf.ground.height[i] : topOf(i));
        bottom = std::min(bottom, topOf.ground.height[i]);
    }
    if (bottom < kVehicle && !hangs) bottom = 0.0f;
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
    setHeights(points, topOf, cluster.hangs, o);
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
