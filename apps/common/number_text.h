/// @file
/// Numbers as text, whatever the locale.
#pragma once

#include <charconv>
#include <string>

namespace lidar_obstacles::apps {

inline std::string fixedText(double value, int decimals) {
    char buffer[400];  // the largest double has 309 digits
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr};
}

/// With its sign.
inline std::string signedText(double value, int decimals) {
    const std::string text = fixedText(value, decimals);
    return text.front() == '-' ? text : '+' + text;
}

inline std::string percentText(double share, int decimals = 1) { return fixedText(100.0 * share, decimals) + " %"; }

}  // namespace lidar_obstacles::apps
