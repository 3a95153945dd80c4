// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace lidar_obstacles {

/// std::floor as an int, without the library call that it is where the compiler may not use SSE 4.1.
inline int floorToInt(float v) {
    const int i = static_cast<int>(v);
    return i - static_cast<int>(v < static_cast<float>(i));
}

/// The same of a double.
inline std::int64_t floorToInt(double v) {
    const auto i = static_cast<std::int64_t>(v);
    return i - static_cast<std::int64_t>(v < static_cast<double>(i));
}

}  // namespace lidar_obstacles
