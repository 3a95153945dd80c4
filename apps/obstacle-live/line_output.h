// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Lines to the standard output.
#pragma once

#include <atomic>
#include <string>

namespace lidar_obstacles::apps {

/// Writes all of it to the standard output, at once; waits for a slow reader.
/// @return false if `stop` was set while it waited.
/// @throws std::runtime_error if it cannot be written, e.g. as nobody reads any more.
bool writeToStdout(const std::string& line, const std::atomic<bool>& stop);

}  // namespace lidar_obstacles::apps
