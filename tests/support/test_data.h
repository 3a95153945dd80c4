// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where tests find recorded data, and what happens where it is missing: a test reports SKIPPED, or fails if the
/// environment variable LIDAR_OBSTACLES_REQUIRE_DATA is 1.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

namespace lidar_obstacles::test {

inline std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

inline bool dataIsRequired() { return environment("LIDAR_OBSTACLES_REQUIRE_DATA") == "1"; }

/// A file of the labelled data (folder LIDAR_OBSTACLES_DATA); empty if it is not there.
inline std::string labelledData(const std::string& name) {
    const std::string folder = environment("LIDAR_OBSTACLES_DATA");
    const std::string path = folder + "/" + name;
    return !folder.empty() && std::filesystem::exists(path) ? path : "";
}

/// The file that an environment variable names; empty if it is not there.
inline std::string environmentFile(const char* name) {
    const std::string path = environment(name);
    return !path.empty() && std::filesystem::exists(path) ? path : "";
}

/// A file that Debian's mrpt-common installs; empty if it is not there.
inline std::string mrptDataset(const std::string& name) {
    const std::string path = "/usr/share/mrpt/datasets/" + name;
    return std::filesystem::exists(path) ? path : "";
}

/// A program of the PATH; empty if there is none.
inline std::string programNamed(const std::string& name) {
    std::istringstream folders(environment("PATH"));
    for (std::string folder; std::getline(folders, folder, ':');)
        if (std::filesystem::exists(folder + "/" + name)) return folder + "/" + name;
    return "";
}

}  // namespace lidar_obstacles::test

/// Defines `variable` as the path of a data file, or ends the test: `LIDAR_OBSTACLES_NEED(path,
/// labelledData("x.pcap"));`
#define LIDAR_OBSTACLES_NEED(variable, found)                                             \
    const std::string variable = ::lidar_obstacles::test::found;                          \
    if (variable.empty()) {                                                               \
        if (::lidar_obstacles::test::dataIsRequired()) FAIL() << #found << " is missing"; \
        GTEST_SKIP() << #found << " is missing";                                          \
    }                                                                                     \
    static_assert(true, "")
