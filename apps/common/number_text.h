/// @file
/// Numbers as text, whatever the locale.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <system_error>
#include <vector>

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

/// Finite numbers with a comma between any two; none where the text is anything else.
inline std::vector<double> readNumbers(const std::string& words) {
    std::vector<double> numbers;
    const char* at = words.data();
    const char* const end = at + words.size();
    while (at <= end) {
        double number = 0.0;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc() || (next != end && *next != ',') || !std::isfinite(number)) break;
        numbers.push_back(number);
        at = next + 1;
    }
    return at <= end ? std::vector<double>{} : numbers;
}

}  // namespace lidar_obstacles::apps
