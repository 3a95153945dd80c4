#pragma once

#include <Eigen/Core>
#include <vector>

#include "lidar_obstacles/params.h"
#include "rectangle.h"

namespace lidar_obstacles {

/// The orientation for which the outline of the points lies best on the two faces turned to the sensor, both at once
/// (after Zhang et al. 2017, "Efficient L-shape fitting"): coarse to fine search, then least squares.
///
/// @param points  returns seen from above, relative to the sensor [m]; at least one.
Orientation fitSeenFaces(const std::vector<Eigen::Vector2d>& points, const PlaneFitParams& params);

}  // namespace lidar_obstacles
