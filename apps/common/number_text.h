// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Numbers as text, whatever the locale.
#pragma once

#include <algorithm>
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

/// The shortest text that reads back as the same number.
template <class Number>
std::string shortestText(Number value) {
    char buffer[64];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

/// Rounded, for JSON.
inline double thousandths(double value) { return std::round(value * 1e3) / 1e3; }

/// With its sign.
inline std::string signedText(double value, int decimals) {
    const std::string text = fixedText(value, decimals);
    return text.front() == '-' ? text : '+' + text;
}

inline std::string percentText(double share, int decimals = 1) { return fixedText(100.0 * share, decimals) + " %"; }

/// Without spaces at its ends.
inline std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Finite numbers with a comma, and spaces where one likes, between any two; none where the text is anything else.
inline std::vector<double> readNumbers(const std::string& words) {
    std::vector<double> numbers;
    for (std::size_t begin = 0; begin <= words.size();) {
        const std::size_t comma = std::min(words.find(',', begin), words.size());
        const std::string word = trimmed(words.substr(begin, comma - begin));
        double number = 0.0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) return {};
        numbers.push_back(number);
        begin = comma + 1;
    }
    return numbers;
}

}  // namespace lidar_obstacles::apps
