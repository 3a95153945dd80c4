// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// merges.csv: what the grouping weighed together, one row per merge and scan.
#pragma once

#include <cstddef>
#include <string>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// The header of merges.csv, with its line end.
std::string mergesHeader();

/// The rows of one scan; "" where nothing was weighed.
std::string mergesRows(double timestamp, std::size_t scan_index, const PointCloud& cloud,
                       const DetectionResult& result);

}  // namespace lidar_obstacles::apps
