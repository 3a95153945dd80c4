// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of obstacle-check.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/input_choice.h"

namespace lidar_obstacles::apps {

struct Options {
    std::string input;
    std::string config;  ///< empty: the built-in defaults
    InputChoice choice;
    std::vector<std::string> set;  ///< section.key=value
    int from = 0;                  ///< number of the first scan
    int scans = 20;                ///< how many are looked at
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then.
/// @throws UsageError
std::optional<Options> parseOptions(int argc, char** argv);

}  // namespace lidar_obstacles::apps
