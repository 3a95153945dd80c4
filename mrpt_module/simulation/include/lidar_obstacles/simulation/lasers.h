// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which lasers a rotating sensor has and in which directions they point.
#pragma once

#include <cstdint>
#include <vector>

#include "lidar_obstacles/simulation/scenario.h"

namespace lidar_obstacles::simulation {

/// Known arrangements of lasers, from their makers' manuals.
enum class LaserLayout : std::uint8_t {
    Vlp16,       ///< 16, 2 degrees apart about the horizon
    Vlp16HiRes,  ///< 16, 4/3 degrees apart about the horizon
    Hdl32,       ///< 32, 4/3 degrees apart, from -30.67 to +10.67 degrees
    Hdl64,       ///< 64, the upper half 1/3 degree apart below +2 degrees, the lower half 1/2 degree down to -24.33
};

/// Elevations in the order the lasers fire [rad].
std::vector<double> elevationsOf(LaserLayout layout);

/// Of these elevations as many as `rings`, evenly chosen as `planes` of the detector does: with k = lasers / rings,
/// ring (k - 1) / 2 counted from the lowest, and every k-th above it. The order they fire in stays.
/// @throws std::invalid_argument unless `rings` divides the number of lasers.
std::vector<double> decimated(const std::vector<double>& elevations, int rings);

struct Laser {
    double elevation = 0.0;  ///< [rad]
    double delay = 0.0;      ///< after the first laser of its firing [s]
    int ring = 0;            ///< counted from the lowest, 0
    bool active = true;      ///< false: silent (SensorSpec::planes)
};

/// The lasers of a sensor in the order they fire. All of them share one firing period, whatever their number.
/// @throws std::invalid_argument if `planes` does not divide their number or two point into one elevation.
std::vector<Laser> lasersOf(const SensorSpec& sensor);

}  // namespace lidar_obstacles::simulation
