// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is told to people.
#pragma once

#include <cstdio>
#include <string>

namespace lidar_obstacles::apps {

/// A line on the standard error.
inline void say(const std::string& text) { std::fprintf(stderr, "obstacle-live: %s\n", text.c_str()); }

}  // namespace lidar_obstacles::apps
