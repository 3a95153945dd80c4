// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Worlds small enough to know by heart: a straight, flat track along x, and what a test puts on it.
#pragma once

#include <string>

#include "lidar_obstacles/simulation/lidar.h"

namespace lidar_obstacles::simulation::test {

/// A flat track of 400 m along x with a vehicle that stands on its middle, sensor at 1.9 m, no noise of the range.
/// `lists` are lines of YAML: `objects:`, `clutter:`. The world's x is the track's s, its y the track's d.
struct SmallWorld {
    std::string lists;
    std::string ego = "[{t: 0, s: 100}]";  ///< way-points
    std::string sensor{};                  ///< further keys, each preceded by ", "
};

std::string scenarioText(const SmallWorld& world);
World worldOf(const SmallWorld& world);

/// Turn `index` of the sensor.
LidarScan scanOf(const World& world, std::size_t index = 0, std::uint64_t seed = 1);

/// Column `name` of row `row` of a CSV text, the header not counted. @throws std::exception if there is none.
std::string csvValue(const std::string& csv, std::size_t row, const std::string& name);
double csvNumber(const std::string& csv, std::size_t row, const std::string& name);

/// Header and rows of the truth about turn `index`.
std::string truthOf(const World& world, std::size_t index = 0);

}  // namespace lidar_obstacles::simulation::test
