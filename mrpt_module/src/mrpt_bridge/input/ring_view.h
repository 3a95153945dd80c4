// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The organised view of clouds that have rings but no firing order.
#pragma once

#include "lidar_obstacles/types.h"
#include "mrpt_bridge/input/sensor_frame.h"

namespace lidar_obstacles {

/// Fills `cloud.view` from `cloud.ring` and the azimuth of each return seen from the sensor. The number of columns is
/// a full turn over the median azimuth step between neighbours in the ring with most returns, 90 .. 4500.
/// @param rings  number of rings of the sensor; larger than every entry of `cloud.ring`.
void buildRingView(const SensorFrame& frame, int rings, PointCloud& cloud);

/// Enters return i at (ring, column) unless a nearer one stands there.
void listInView(PointCloud& cloud, std::size_t i, int column);

}  // namespace lidar_obstacles
