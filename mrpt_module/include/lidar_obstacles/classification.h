/// @file
/// Class of an obstacle by its size (Mentasti et al., Sec. III.A: "based on the area and shape").
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Class by the size of what is seen.
ObstacleClass classify(const Obstacle& obstacle, const ClassParams& params);

/// Makes the box fit its class. A person has no heading: its sides tell nothing of where it goes (Sec. IV). A rider's
/// is along the ride: the longer side, and only where that is clearly the longer one. What is none of these has none.
void applyClass(Obstacle& obstacle);

/// Sets the class of each obstacle. A pedestrian loses its heading: the sides of a person tell nothing of where it goes
/// (Sec. IV).
std::vector<Obstacle> classifyAll(std::vector<Obstacle> obstacles, const ClassParams& params);

}  // namespace lidar_obstacles
