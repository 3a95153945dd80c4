// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lidar_obstacles {

/// The text of the model that is compiled in: datasets/models/recognizer.txt.
std::string builtinModel();

}  // namespace lidar_obstacles
