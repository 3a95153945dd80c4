// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/types.h"
#include "objects/footprint.h"

namespace lidar_obstacles {

/// The shortest way between the outlines of two components.
struct Gap {
    std::int32_t from = -1;  ///< return of the one component
    std::int32_t to = -1;    ///< of the other
    float length = 1e9f;     ///< [m]
};

Gap gapBetween(const Footprint& a, const Footprint& b);

}  // namespace lidar_obstacles
