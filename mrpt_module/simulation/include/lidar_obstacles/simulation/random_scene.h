// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scenes drawn from a seed: layout, objects, clutter, terrain, sensor.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/simulation/scenario.h"

namespace lidar_obstacles::simulation {

enum class RandomScene : std::uint8_t { Street, CarPark, Sidewalk, ForestRoad, Track, Park, OpenRoad };

/// "street", "car-park", "sidewalk", "forest-road", "track", "park" or "open-road".
const char* toString(RandomScene kind);
/// The kind of that name; none if there is no such kind.
std::optional<RandomScene> randomSceneNamed(const std::string& name);
const std::vector<RandomScene>& randomScenes();

/// A scene of that kind, four seconds long. Everything in it follows from kind and seed, to the last byte: where the
/// vehicle drives, what stands, drives and walks there and how it looks, the terrain, the sensor (0.4 to 3 m high,
/// tilted, range noise of 0.5 to 3 cm, lost shots; what its recorded pose does not know). Nothing stands or moves
/// inside something else; crowns may reach over what is lower.
Scenario randomScenario(RandomScene kind, std::uint64_t seed);

/// Elevations of 16 lasers drawn from kind and seed, for SensorSpec::elevations: those of a VLP-16 in half of all
/// scenes, else of one with narrower steps, every second one of an HDL-32 or every fourth one of an HDL-64. The scene
/// itself stays as it is.
/// @return in the order the lasers fire [rad]
std::vector<double> randomLasers(RandomScene kind, std::uint64_t seed);

}  // namespace lidar_obstacles::simulation
