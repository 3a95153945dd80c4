// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Temporary files without a name: gone when they are closed, whatever way the program ends.
#pragma once

#include <string>

namespace lidar_obstacles::apps {

/// Where temporary files are made; "/tmp" if the system names no folder that is there.
std::string temporaryFolder();

/// @return a file descriptor for reading and writing.
/// @throws std::runtime_error naming the folder if there can be none.
int openNamelessFile();

}  // namespace lidar_obstacles::apps
