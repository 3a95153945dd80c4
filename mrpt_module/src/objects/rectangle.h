// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// How a box is turned, and what says so. Seen from above; points are told relative to the sensor.
struct Orientation {
    double angle = 0.0;      ///< of one pair of faces [rad]; the other is at right angles
    double angle_std = 0.0;  ///< its standard deviation, from the points that say so [rad]
    int support = 0;         ///< these points' number
    HeadingRule rule = HeadingRule::None;
    std::vector<Eigen::Vector2d> marks;  ///< see Obstacle::marks
};

/// Rectangle in the plane: p = u * (cos a, sin a) + v * (-sin a, cos a) with u, v inside the limits [m].
struct Rectangle {
    double angle = 0.0;  ///< of the u axis [rad]
    double u_min = 0.0, u_max = 0.0, v_min = 0.0, v_max = 0.0;
    double u_seen = 0.0;  ///< how far the nearer face across u is turned to the sensor: 0 (grazing or away) .. 1
    double v_seen = 0.0;  ///< the same for v

    double size_u() const { return u_max - u_min; }
    double size_v() const { return v_max - v_min; }
    Eigen::Vector2d u_axis() const { return {std::cos(angle), std::sin(angle)}; }
    Eigen::Vector2d v_axis() const { return {-std::sin(angle), std::cos(angle)}; }
    Eigen::Vector2d center() const { return 0.5 * (u_min + u_max) * u_axis() + 0.5 * (v_min + v_max) * v_axis(); }
};

/// Where most of these returns are seen from: the place of their sensor, from above [m].
Eigen::Vector2f viewpointOf(const std::vector<std::int32_t>& points, const PointCloud& cloud);

/// Returns seen from above, relative to a viewpoint [m].
std::vector<Eigen::Vector2d> seenFromAbove(const std::vector<std::int32_t>& points, const PointCloud& cloud,
                                           const Eigen::Vector2f& viewpoint);

/// At most `most` of the items, evenly taken from all.
template <class T>
std::vector<T> everyKth(const std::vector<T>& items, std::size_t most) {
    if (items.size() <= most) return items;
    std::vector<T> fewer;
    fewer.reserve(most);
    for (std::size_t k = 0; k < most; ++k) fewer.push_back(items[k * items.size() / most]);
    return fewer;
}

/// The two edges turned to the sensor (at the origin), told along an axis u and v at right angles; not seen where the
/// points lie to both sides of the sensor.
struct SeenEdges {
    double u = 0.0;
    double v = 0.0;
    bool u_seen = false;
    bool v_seen = false;
};

SeenEdges seenEdges(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& axis);

/// Turns an orientation so that it fits both seen faces best, by least squares over the points within the distance of
/// the edges: those near the edge across v and, turned by 90 degrees, those near the edge across u share one direction.
/// Sets its standard deviation and support.
void alignWithFaces(const std::vector<Eigen::Vector2d>& outline, const std::vector<Eigen::Vector2d>& points,
                    double distance, Orientation& orientation);

/// The rectangle around the points, turned as told, in the frame of the points. The seen faces lie on the outermost
/// tenth of the points within the distance of them.
Rectangle enclose(const std::vector<Eigen::Vector2d>& points, double angle, double distance);

}  // namespace lidar_obstacles
