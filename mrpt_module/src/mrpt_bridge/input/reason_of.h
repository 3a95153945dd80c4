// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <string>

namespace lidar_obstacles {

/// The line of an MRPT exception that says what happened: the rest is a call stack.
inline std::string reasonOf(const std::exception& e) {
    const std::string text = e.what();
    const std::string mark = "Message:";
    // The innermost exception comes last.
    const std::size_t at = text.rfind(mark);
    std::string line = at == std::string::npos ? text : text.substr(at + mark.size());
    line = line.substr(0, line.find('\n'));
    const std::size_t begin = line.find_first_not_of(" \t");
    return begin == std::string::npos ? "unreadable object" : line.substr(begin);
}

}  // namespace lidar_obstacles
