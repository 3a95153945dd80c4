// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

namespace lidar_obstacles::apps {

/// The message without the call stack that MRPT adds to its own.
inline std::string messageOf(const std::exception& e) {
    std::string text = e.what();
    const std::string mark = "Message:";
    const auto at = text.find(mark);
    if (at == std::string::npos) return text;
    const auto begin = text.find_first_not_of(" \n", at + mark.size());
    if (begin == std::string::npos) return text;
    return text.substr(begin, text.find('\n', begin) - begin);
}

}  // namespace lidar_obstacles::apps
