// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lidar_obstacles/params.h"
#include "objects/rectangle.h"

namespace lidar_obstacles {

/// A vertical plane seen from above: the points p with normal . p = offset.
struct VerticalPlane {
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< unit length, towards the sensor
    double offset = 0.0;                                ///< [m]
    double normal_std = 0.0;                            ///< standard deviation of the normal's direction [rad]
    int support = 0;                                    ///< returns on it; 0: none was found
};

/// The vertical plane turned to the sensor that most points lie on: seeded RANSAC, then least squares on its inliers.
///
/// @param points  seen from above, relative to the sensor [m]. Fewer than two distinct ones support no plane.
VerticalPlane fitFacingPlane(const std::vector<Eigen::Vector2d>& points, const RansacParams& params);

/// The plane's orientation by a rule; `marks` are the two ends of the points on it.
Orientation orientationOf(const VerticalPlane& plane, const std::vector<Eigen::Vector2d>& points, double distance,
                          HeadingRule rule);

}  // namespace lidar_obstacles
