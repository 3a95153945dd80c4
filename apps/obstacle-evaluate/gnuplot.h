// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Plots by gnuplot.
#pragma once

#include <filesystem>
#include <string>

namespace lidar_obstacles::apps {

/// True if there is a gnuplot that can be run.
bool hasGnuplot();

/// Writes `script` to `<stem>.gp` and lets gnuplot run it: it draws what its `set output` lines say. Relative names in
/// it are meant from the folder of the script, so that it can be run again by hand.
/// @throws std::runtime_error with gnuplot's message if it fails.
void plot(const std::filesystem::path& stem, const std::string& script);

}  // namespace lidar_obstacles::apps
