// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arrows that lie flat.
#pragma once

#include <mrpt/opengl/CSetOfTriangles.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace lidar_obstacles {

/// Where a flat arrow begins, points to and how far it reaches.
struct FlatArrow {
    Eigen::Vector3d from = Eigen::Vector3d::Zero();  ///< [m]
    double yaw = 0.0;                                ///< [rad]
    double length = 0.0;                             ///< with the head [m]
    double width = 0.14;                             ///< of the shaft [m]
    double scale = 1.0;                              ///< of the shaft's width and of the head
};

/// A short arrow is scaled up less, or it would be wider than long.
inline void addArrow(const FlatArrow& arrow, const mrpt::img::TColor& color, mrpt::opengl::CSetOfTriangles& triangles) {
    const double scale = std::min(arrow.scale, std::max(1.0, arrow.length));
    const double head = std::min(0.7 * scale, 0.5 * arrow.length);
    const double neck = arrow.length - head;
    const double half = 0.5 * arrow.width * scale;
    const double barb = half + 0.23 * scale;
    const double c = std::cos(arrow.yaw);
    const double s = std::sin(arrow.yaw);
    const auto at = [&](double along, double across) {
        return mrpt::math::TPoint3Df(static_cast<float>(arrow.from.x() + c * along - s * across),
                                     static_cast<float>(arrow.from.y() + s * along + c * across),
                                     static_cast<float>(arrow.from.z()));
    };
    const auto add = [&](const auto& p, const auto& q, const auto& r) {
        mrpt::opengl::TTriangle t(p, q, r);
        t.setColor(color);
        triangles.insertTriangle(t);
    };
    add(at(0.0, -half), at(neck, -half), at(neck, half));
    add(at(0.0, -half), at(neck, half), at(0.0, half));
    add(at(neck, -barb), at(arrow.length, 0.0), at(neck, barb));
}

}  // namespace lidar_obstacles
