// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// For each candidate 1 if enough other candidates of the same scan are near it (VoxelFilter), else 0.
std::vector<std::uint8_t> supportedInSpace(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                           const OctomapParams& params);

}  // namespace lidar_obstacles
