#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Gives a cloud without ring numbers rings and a view: rings from the elevations above the sensor's horizon where
/// these fall on steps, as those of a spinning lidar do; else bands of 2 degrees, in each of which the nearest return
/// of a direction is listed. A cloud with a view is returned as it is.
PointCloud organized(PointCloud cloud);

}  // namespace lidar_obstacles
