// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of obstacle-track.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/run_app.h"
#include "lidar_obstacles/params.h"

namespace lidar_obstacles::apps {

struct Options {
    std::string detections;
    std::string ego;  ///< empty: the vehicle stands
    std::string output;
    std::string config;  ///< empty: the built-in defaults
    std::vector<std::string> set;
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then. @throws UsageError
std::optional<Options> parseOptions(int argc, char** argv);

}  // namespace lidar_obstacles::apps
