// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of octomap-build.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/input_choice.h"
#include "common/run_app.h"
#include "lidar_obstacles/params.h"

namespace lidar_obstacles::apps {

struct Options {
    std::string input;
    std::string output;  ///< .bt or .ot
    std::string config;  ///< empty: the built-in defaults
    InputChoice choice;
    int from = 0;
    int to = std::numeric_limits<int>::max();
    int every = 1;
    std::vector<std::string> set;
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then. @throws UsageError
std::optional<Options> parseOptions(int argc, char** argv);

}  // namespace lidar_obstacles::apps
