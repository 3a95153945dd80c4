// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the grouping weighed, for people who ask why two pieces are one object or are not.
#pragma once

#include <array>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Two hypotheses that were weighed as one.
struct Merge {
    int whole = -1;                   ///< hypothesis that they would be, its place in DetectionResult::hypotheses
    std::array<int, 2> part{-1, -1};  ///< the two
    float apart = 0.0f;               ///< returns in whole objects if they are cut apart in the best way
    float together = 0.0f;            ///< and if they are taken for one; at least `apart` where they are better one
    bool taken = false;               ///< both are in one group
};

/// The merges that were weighed, in the order of the hypotheses they made; none for the bare paper.
std::vector<Merge> mergesOf(const std::vector<Hypothesis>& hypotheses);

}  // namespace lidar_obstacles
