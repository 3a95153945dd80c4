// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacles.csv: one row per obstacle and scan.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// The header of obstacles.csv, with its line end.
std::string csvHeader();

/// The rows of one scan, one per obstacle; "" without obstacles. Cells of which nothing is known are empty:
/// `probability`, and from `age` on what only a tracker knows.
std::string csvRows(double timestamp, std::size_t scan_index, const std::vector<Obstacle>& obstacles);

}  // namespace lidar_obstacles::apps
