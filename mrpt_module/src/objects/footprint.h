// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What a cluster covers seen from above: its outermost returns in 16 directions, enough to tell sizes to a few per
/// cent. They stand in the order of the directions, counter-clockwise from +x, and so outline a convex polygon; a
/// return that is the outermost in several directions is listed for each.
struct Footprint {
    static constexpr int kDirections = 16;
    using Numbers = Eigen::Array<float, kDirections, 1>;

    Eigen::AlignedBox2f box;      ///< along the vehicle's axes [m]; empty for no returns
    Numbers x = Numbers::Zero();  ///< of the outermost return in each direction [m]
    Numbers y = Numbers::Zero();  ///< [m]
    Numbers reach = Numbers::Constant(-std::numeric_limits<float>::infinity());  ///< its place along the direction [m]
    std::array<std::int32_t, kDirections> returns{};                             ///< its index into the cloud

    bool empty() const { return box.isEmpty(); }
};

/// Box along the vehicle's axes around some returns of the cloud [m].
Eigen::AlignedBox2f boundsOf(const std::vector<std::int32_t>& points, const PointCloud& cloud);

/// The footprint of some returns of the cloud.
Footprint footprintOf(const std::vector<std::int32_t>& points, const PointCloud& cloud);

/// The same of `count` returns that lie side by side.
Footprint footprintOf(const std::int32_t* points, std::size_t count, const PointCloud& cloud);

/// The footprint of two together.
Footprint merged(const Footprint& a, const Footprint& b);

/// The rectangle of least area around a footprint.
struct SmallestRectangle {
    float length = 0.0f;                               ///< of the longer side [m]
    float width = 0.0f;                                ///< of the shorter [m]
    Eigen::Vector2f along = Eigen::Vector2f::UnitX();  ///< direction of the longer side, unit length
};

/// One of its sides lies along an edge of the outline (Freeman and Shapira 1975); of those as small the longest. All
/// zero for no returns; no width for returns on a line.
///
/// cv::minAreaRect does the same for any points, at many times the cost: it is asked for hundreds of times a scan.
SmallestRectangle smallestRectangle(const Footprint& f);

/// Is the smallest rectangle around what a box with these sides holds surely no larger than that? Its longer side is no
/// longer than the box's diagonal, its shorter side no longer than the root of the box's area.
inline bool surelyWithin(const Eigen::Vector2f& sides, double max_length, double max_width) {
    return sides.squaredNorm() <= max_length * max_length && sides.prod() <= max_width * max_width;
}

}  // namespace lidar_obstacles
