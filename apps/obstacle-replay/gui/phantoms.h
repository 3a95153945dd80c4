// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Road users where the truth has nothing.
#pragma once

#include <vector>

#include "lidar_obstacles/mrpt_bridge/scene_layers.h"

namespace lidar_obstacles::apps {

/// Numbers of the vehicles, pedestrians and cyclists that were seen in a scan within 30 m, and ahead within the angle
/// that is labelled, and do not come nearer than 0.3 m to any labelled object, whatever its type. None where the scan
/// has no labelled object at all: it may not have been labelled.
/// @param fov_deg  of the labels, around straight ahead; 360: all around.
std::vector<int> phantomsIn(const std::vector<Obstacle>& obstacles, const std::vector<TruthBox>& truth, double fov_deg);

}  // namespace lidar_obstacles::apps
