#pragma once

namespace lidar_obstacles {

/// std::floor as an int, without the library call that it is where the compiler may not use SSE 4.1.
inline int floorToInt(float v) {
    const int i = static_cast<int>(v);
    return i - static_cast<int>(v < static_cast<float>(i));
}

}  // namespace lidar_obstacles
