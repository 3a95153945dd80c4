// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The window of obstacle-replay --gui. Without Dear ImGui and GLFW window_missing.cpp stands for it.
#pragma once

#include "lidar_obstacles/params.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// Shows the input in a window until it is closed.
/// @throws UsageError if there is no display, the program was built without windows, or the command line does not fit
///     the input; std::runtime_error if the input cannot be read.
void showWindow(const Options& options, const DetectorParams& params);

}  // namespace lidar_obstacles::apps
