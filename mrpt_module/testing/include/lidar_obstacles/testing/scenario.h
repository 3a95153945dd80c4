// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The detector on a simulated drive, for unit tests that need no file. There where the library was built with the
/// simulation.
#pragma once

#include <string>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/simulation/recording.h"
#include "lidar_obstacles/testing/rawlog.h"

namespace lidar_obstacles::testing {

/// Which turns of the sensor are simulated, and how they are processed.
struct ScenarioOptions {
    DetectorParams params;
    simulation::RunOptions run;
};

/// Simulates a scenario as obstacle-simulate does and runs the detector over it, fed with the poses of the simulated
/// vehicle. `yaml` is the text of a scenario (datasets/scenarios/README.md has the keys).
/// @throws simulation::ScenarioError if the text is no scenario; std::invalid_argument if a parameter is out of range,
///     or the options leave no turn of the sensor.
RawlogResult detectScenario(const std::string& yaml, const ScenarioOptions& options = {});

}  // namespace lidar_obstacles::testing
