// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// segmentGround() of a cloud and parameters that are known to be valid.
GroundModel segmentCheckedGround(const PointCloud& cloud, const GroundParams& params);

}  // namespace lidar_obstacles
