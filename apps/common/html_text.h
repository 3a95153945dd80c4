// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Text in HTML pages.
#pragma once

#include <string>

namespace lidar_obstacles::apps {

/// Text as HTML shows it, in attributes as well: &, <, > and " made harmless.
std::string escaped(const std::string& text);

}  // namespace lidar_obstacles::apps
