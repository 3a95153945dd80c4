// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Obstacles as label files of the KITTI object benchmark, one per scan.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// The lines of one label file: `type truncated occluded alpha bbox(4) height width length x y z rotation_y score`.
///
/// There is no camera: its frame is taken to be the vehicle frame with the axes renamed (x right = -y, y down = -z,
/// z forward = x), at the vehicle's origin. x y z is the middle of the box's bottom, rotation_y = -yaw - pi/2. What
/// only a picture could tell is set as the benchmark says "unknown": truncated, occluded and bbox -1; alpha is -10
/// where the heading is not valid. The score is the probability of the class; 0 where classes were told by size.
/// Classes: Car, Pedestrian, Cyclist, and Misc for the rest.
std::string kittiLines(const std::vector<Obstacle>& obstacles);

/// The lines of one scan in a result file of the KITTI tracking benchmark: `frame track_id` before what is said above.
/// Only tracks; "" without any.
std::string kittiTrackingLines(std::size_t scan_index, const std::vector<Obstacle>& obstacles);

}  // namespace lidar_obstacles::apps
