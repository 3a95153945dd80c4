// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What several sensors of a vehicle saw at about the same time, as one cloud.
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Joins the scans of several sensors. Each return keeps its own ray (PointCloud::originOf) and is beside and above
/// returns of its own sensor only. `timestamp` is that of the first cloud, `time_offset` counts from it and may be
/// negative; returns of a cloud without times are as of its timestamp.
///
/// Rings are counted upwards in the vehicle's frame, also those of a sensor that hangs upside down. A sensor that is
/// tilted by more than 20 degrees has no such rings: its view has bands of 2 degrees of elevation instead. Columns are
/// directions in the vehicle's frame, the same for all.
///
/// What moved between the scans is not undone here: deskew() does that, by the offsets.
///
/// @param clouds  vehicle frame [m]; one alone is returned as it is, none gives an empty cloud.
PointCloud joinedCloud(std::vector<PointCloud> clouds);

/// Number of the sensor that has most of these returns (indices into the cloud), from 0; 0 for a cloud of one sensor.
std::size_t sensorThatSaw(const std::vector<std::int32_t>& points, const PointCloud& cloud);

}  // namespace lidar_obstacles
