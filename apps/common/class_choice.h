// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// `--classes`: which classes of obstacles a tool reports.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

constexpr const char* kClassesHelp =
    "classes to report, several with commas: vehicle, pedestrian, cyclist, structure (walls, vegetation, poles), "
    "unknown; default all";

using ClassChoice = std::set<ObstacleClass>;  ///< empty: all

/// @throws UsageError naming the word that is no class.
ClassChoice parseClasses(const std::vector<std::string>& words);

/// Takes the obstacles of other classes away.
void keepChosen(const ClassChoice& chosen, std::vector<Obstacle>& obstacles);

}  // namespace lidar_obstacles::apps
