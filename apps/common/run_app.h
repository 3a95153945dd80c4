// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What every tool begins and ends with: its command line, its exit code.
#pragma once

#include <functional>
#include <stdexcept>

namespace CLI {
class App;
}

namespace lidar_obstacles::apps {

/// A command line that is not right.
class UsageError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Reads the command line; false if it asked for --help or --version, which are printed then.
/// @throws UsageError that names the tool's --help and, for a misspelt option, the one that is meant.
bool parse(CLI::App& app, int argc, char** argv);

/// Runs a tool and tells on the standard error why it failed: "TOOL: error: ...".
/// @return what `run` gives; 2 if the command line or the configuration is not right (UsageError, ConfigError,
///     std::invalid_argument), 1 for whatever else it throws.
int runApp(const char* tool, const std::function<int()>& run);

}  // namespace lidar_obstacles::apps
