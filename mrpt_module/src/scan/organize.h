// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

constexpr int kUsualColumns = 1800;  ///< of a VLP-16 at 10 Hz

/// Column of a direction in the vehicle's frame where columns begin behind and run counter-clockwise.
int columnOf(const Eigen::Vector3f& way, int columns);

/// Lists return i in the view, at its ring and column, where no nearer one is listed there.
/// @param origin  where their rays start.
void listNearest(std::int32_t i, const Eigen::Vector3f& origin, PointCloud& cloud);

/// Gives a cloud without ring numbers rings and a view: rings from the elevations above the sensor's horizon where
/// these fall on steps, as those of a spinning lidar do; else bands of 2 degrees, in each of which the nearest return
/// of a direction is listed. A cloud with a view is returned as it is.
/// @param columns  of a turn.
PointCloud organized(PointCloud cloud, int columns = kUsualColumns);

/// True unless the sensor hangs upside down or is tilted by more than 20 degrees.
bool standsUpright(const PointCloud& cloud);

/// True for a cloud that facingUp() has nothing to do with: it stands upright and has a view, or no returns.
bool facesUp(const PointCloud& cloud);

/// With a view whose rings count upwards in the vehicle's frame: those of a sensor that hangs upside down the other way
/// round, those of one that is tilted by more than 20 degrees not at all, but bands of 2 degrees of elevation; what
/// stands upright is organized() where it has no view.
PointCloud facingUp(PointCloud cloud);

}  // namespace lidar_obstacles
