// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Streets to cross, drawn from a seed.
#pragma once

#include <cstdint>

#include "lidar_obstacles/simulation/scenario.h"

namespace lidar_obstacles::examples {

constexpr double kMiddle = 200.0;   ///< s of the place where the robot crosses [m]
constexpr double kRoadEdge = 3.4;   ///< the roadway lies between -kRoadEdge and kRoadEdge [m]
constexpr double kStart = -6.0;     ///< d of the robot at first [m]
constexpr double kGoal = 6.0;       ///< and where it wants to go [m]
constexpr double kDuration = 60.0;  ///< [s]

/// Two lanes of cars and riders at 4 to 8 m/s, people who walk along and across, parked cars, trees and poles, houses
/// on both sides. Nobody minds the robot; nobody runs into anybody else.
simulation::Scenario crossingScene(std::uint64_t seed);

}  // namespace lidar_obstacles::examples
