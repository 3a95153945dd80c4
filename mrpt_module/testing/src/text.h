// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Numbers in messages.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace lidar_obstacles::testing {

/// With `decimals` digits behind the point; "0.0", never "-0.0".
inline std::string number(double value, int decimals = 1) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    const std::string digits = text;
    return digits.find_first_of("123456789") == std::string::npos && digits[0] == '-' ? digits.substr(1) : digits;
}

inline std::string degrees(double rad) { return number(rad * 180.0 / M_PI, 0) + " deg"; }

/// "(12.0, -3.5)"
inline std::string place(double x, double y) { return "(" + number(x) + ", " + number(y) + ")"; }

}  // namespace lidar_obstacles::testing
