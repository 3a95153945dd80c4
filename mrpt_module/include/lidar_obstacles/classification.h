/// @file
/// What a box's class says about the box.
#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Makes the box fit its class. A person has no heading: its sides tell nothing of where it goes (Sec. IV). A rider's
/// is along the ride: the longer side, and only where that is clearly the longer one. Vehicles and what is unknown
/// stay.
void applyClass(Obstacle& obstacle);

}  // namespace lidar_obstacles
