/// @file
/// People on foot and on bicycles.
#pragma once

#include <string>

#include "lidar_obstacles/simulation/models.h"

namespace lidar_obstacles::simulation {

/// A person of that height [m], standing or in eight steps of a walk. The box is the smallest that holds them all.
Model personModel(const std::string& name, double height, bool walking);

/// A person on a bicycle.
Model cyclistModel();

}  // namespace lidar_obstacles::simulation
