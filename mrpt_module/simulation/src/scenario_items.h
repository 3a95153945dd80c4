// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The lists of a scenario file: way-points, road users, clutter.
#pragma once

#include <vector>

#include "lidar_obstacles/simulation/scenario.h"
#include "mrpt_bridge/yaml_map.h"

namespace lidar_obstacles::simulation {

/// Way-points under key `path`; their place along the track stands under `s_key`. @throws ScenarioError
std::vector<Waypoint> readWaypoints(YamlMap& map, const std::string& s_key);

/// One entry of `objects`: one road user, or a row of them. @throws ScenarioError
std::vector<ObjectSpec> readObjects(YamlMap& map);

/// One entry of `clutter`: one thing, or a row, on one or several lines along the track. @throws ScenarioError
std::vector<ClutterSpec> readClutter(YamlMap& map);

}  // namespace lidar_obstacles::simulation
