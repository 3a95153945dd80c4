// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "ground/near_ground.h"
#include "lidar_obstacles/low_things.h"

namespace lidar_obstacles {

/// A beam that shows a step, a drop, or no ground.
struct LowMark {
    int ring = 0, column = 0;
    LowKind kind = LowKind::Raised;
    float from = 0.0f, to = 0.0f;  ///< range of the span [m]
};

/// All beams of a sensor that do, one mark at most for each: ring by ring, in the order of the columns.
std::vector<LowMark> lowMarks(const NearGround& near);

}  // namespace lidar_obstacles
