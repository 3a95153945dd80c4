// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The obstacles of a scan as the replay page reads them: rows of whole numbers in JSON.
#pragma once

#include <string>

#include "exports/scan_output.h"

namespace lidar_obstacles::apps {

/// `[scan_index, time [s], pose, returns, [row..]]`, obstacles of all classes but structure. pose:
/// `[x,y,z,qx,qy,qz,qw]` (world <- vehicle), or 0 where it is not known.
///
/// A row: id, class (ObstacleClass), x, y, z, length, width, height [cm], yaw [mrad], flags (1 heading valid, 2 seen in
/// this scan, 4 moving, 8 direction known, 16 velocity known, 32 a track), returns, rings, distance [cm], then where it
/// is a track: vx, vy, their errors [cm/s], age [ms], and of each class the probability [1/1000].
std::string pageRow(const ScanOutput& scan);

/// `[row..]` of the obstacles of class structure, up to the distance.
std::string pageStructure(const ScanOutput& scan);

}  // namespace lidar_obstacles::apps
