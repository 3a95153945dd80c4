// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An occupancy grid as an image, and back.
#pragma once

#include <opencv2/core.hpp>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// The CellState of every cell, rows = y, cols = x; empty for an empty grid.
cv::Mat1b stateImage(const OccupancyGrid& grid);
/// The grid with these states; `place_of_candidate` is left empty.
OccupancyGrid gridOf(const cv::Mat1b& states, const Eigen::Vector2d& origin, double resolution);

}  // namespace lidar_obstacles
