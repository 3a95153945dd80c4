// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of obstacle-simulate.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/run_app.h"
#include "lidar_obstacles/simulation/random_scene.h"
#include "lidar_obstacles/simulation/recording.h"

namespace lidar_obstacles::apps {

struct Options {
    std::string scenario;                           ///< empty: a random scene
    std::optional<simulation::RandomScene> random;  ///< in place of a file
    std::string output = "output/simulation";       ///< prefix of the files
    simulation::RunOptions run;
    bool odometry = false;
    // In place of what the scenario says:
    std::optional<int> planes;
    std::optional<double> rate;
    std::optional<double> rain;
    std::optional<simulation::Pose6> mount;  ///< of the sensor on the vehicle
    std::optional<double> height;            ///< of the sensor
    std::optional<simulation::Pose6> mount_error;
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then.
/// @throws UsageError
std::optional<Options> parseOptions(int argc, char** argv);

/// The scenario that the command line names: from its file or drawn. @throws simulation::ScenarioError
simulation::Scenario scenarioOf(const Options& options);

/// The scenario with what the command line changes.
simulation::Scenario changed(simulation::Scenario scenario, const Options& options);

}  // namespace lidar_obstacles::apps
