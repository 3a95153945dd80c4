// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// JSON schemas of Foxglove's messages: the fields, without the texts that explain them.
#pragma once

#include <string>

namespace lidar_obstacles::apps {

/// @param name  "SceneUpdate", "PointCloud", "Grid", "FrameTransform" or "Log".
/// @throws std::invalid_argument for any other.
std::string foxgloveSchema(const std::string& name);

}  // namespace lidar_obstacles::apps
