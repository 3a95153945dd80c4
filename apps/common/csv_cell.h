// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace lidar_obstacles::apps {

/// A text as a cell of a CSV file: quoted where it asks for it.
inline std::string csvCell(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string cell = "\"";
    for (const char c : text) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
    return cell + "\"";
}

}  // namespace lidar_obstacles::apps
