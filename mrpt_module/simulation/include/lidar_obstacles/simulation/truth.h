// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Ground truth of a scan, as rows of CSV files. Lines end with '\n'; see datasets/scenarios/README.md for the columns.
#pragma once

#include <string>

#include "lidar_obstacles/simulation/lidar.h"

namespace lidar_obstacles::simulation {

/// Seconds since the epoch of the time 0 of every scenario, a full hour.
constexpr double kEpoch = 1609459200.0;

std::string truthHeader();
/// One row for each object within the sensor's reach, seen or not; vehicle frame. @param scan_index  as recorded.
std::string truthRows(const World& world, const TurnPoses& poses, const LidarScan& scan, std::size_t scan_index);

std::string egoHeader();
/// The vehicle's exact pose in the world at the scan's timestamp and at its middle.
std::string egoRow(const TurnPoses& poses, const LidarScan& scan, std::size_t scan_index);

/// Header and rows of the clutter; world frame.
std::string staticTable(const World& world);

}  // namespace lidar_obstacles::simulation
