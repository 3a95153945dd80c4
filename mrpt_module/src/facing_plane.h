#pragma once

#include <Eigen/Core>
#include <vector>

#include "lidar_obstacles/params.h"

namespace lidar_obstacles {

/// A vertical plane seen from above: the points p with normal . p = offset.
struct VerticalPlane {
    Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< unit length, towards the sensor
    double offset = 0.0;                                ///< [m]
    double normal_std = 0.0;                            ///< standard deviation of the normal's direction [rad]
    int support = 0;                                    ///< returns on it; 0: none was found
};

/// The vertical plane turned to the sensor that most returns lie on (Sec. III.A, Fig. 3): seeded RANSAC, then least
/// squares on its inliers.
///
/// @param points  returns seen from above, relative to the sensor [m]. Fewer than two distinct ones support no plane.
VerticalPlane fitFacingPlane(const std::vector<Eigen::Vector2d>& points, const PlaneFitParams& params);

}  // namespace lidar_obstacles
