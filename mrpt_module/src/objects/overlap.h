// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Area that two boxes share, seen from above [m^2].
double sharedArea(const OrientedBox& a, const OrientedBox& b);

/// Two things do not stand in one place. Where two boxes of road users share more than a tenth of the smaller, seen
/// from above, first what completion added is taken back; what then still lies in another's box belongs to it, unless
/// it is of another class: a person beside a door is one.
///
/// @return the obstacles that stay, in their order; the returns of those that do not go to the box they lie in.
std::vector<Obstacle> withoutOverlaps(std::vector<Obstacle> obstacles, const GroundModel& ground);

}  // namespace lidar_obstacles
