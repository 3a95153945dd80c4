// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parameters that --config and --set of a tool ask for.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/params.h"

namespace lidar_obstacles::apps {

/// @param config       file; empty: the built-in defaults.
/// @param assignments  "section.key=value" each, after the file's.
/// @throws ConfigError, std::invalid_argument, std::runtime_error as loadParams(), setParam() and validate().
DetectorParams readParams(const std::string& config, const std::vector<std::string>& assignments);

}  // namespace lidar_obstacles::apps
