// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Numbers in texts: of places (own body, outline, what is not searched), zones and parameters.
#pragma once

#include <charconv>
#include <string>

namespace lidar_obstacles {

/// What may stand between numbers.
inline constexpr const char* kBlanks = " \t\r\n,";

/// The shortest text that reads back as the same number.
template <class Number>
std::string numberText(Number value) {
    char buffer[64];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace lidar_obstacles
