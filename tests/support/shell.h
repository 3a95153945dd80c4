// SPDX-License-Identifier: BSD-3-Clause
// Commands of the shell.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

namespace lidar_obstacles::test {

/// Runs a command; its exit code, -1 if it was killed.
inline int shell(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace lidar_obstacles::test
