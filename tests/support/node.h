// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Programs of Node.js that tests ask: readers that others wrote. Needs LIDAR_OBSTACLES_NODE
/// ("<repository>/tests/node") and LIDAR_OBSTACLES_NODE_MODULES, where scripts/test.sh installs what they use.
#pragma once

#include <filesystem>
#include <string>

#include "support/shell.h"

namespace lidar_obstacles::test {

/// Why a program of tests/node cannot run; "" where it can. @param package  that it needs; "" for none.
inline std::string nodeIsMissing(const std::string& package) {
    if (shell("node --version >/dev/null 2>&1") != 0) return "there is no node (Debian: nodejs)";
    const std::string folder = std::string(LIDAR_OBSTACLES_NODE_MODULES) + "/" + package;
    if (!package.empty() && !std::filesystem::exists(folder))
        return "there is no " + folder + ": scripts/test.sh installs it where there is npm";
    return "";
}

}  // namespace lidar_obstacles::test

/// Skips a test where a program of tests/node cannot run.
#define LIDAR_OBSTACLES_NEED_NODE(package)                                         \
    do {                                                                           \
        const std::string missing = lidar_obstacles::test::nodeIsMissing(package); \
        if (!missing.empty()) GTEST_SKIP() << missing;                             \
    } while (false)
