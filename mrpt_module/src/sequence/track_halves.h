// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Lorries with trailers, and buses in two parts, may be followed as two.
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Adds the whole of each two vehicles that may be its halves: as high as a lorry, one behind the other with a gap as
/// at a drawbar, as fast as each other, and nobody between them. Where they were once told apart they are expected
/// apart in each scan that follows; as they are expected together as well, each scan says anew whether they are one.
/// @param objects vehicle frame; what is added stands at the end
/// @param velocities one for each object, world frame [m/s]
void addWholes(std::vector<ExpectedObject>& objects, const std::vector<Eigen::Vector2d>& velocities);

}  // namespace lidar_obstacles
