// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"
#include "objects/follow_up.h"

namespace lidar_obstacles {

/// Longest side of a box of structure [m].
inline constexpr float kLongestStructureBox = 6.0f;

/// Boxes that follow a wall, a hedge or the like: pieces of at most 6 m, each the smallest upright box around its
/// returns. A piece is cut in two as long as that leaves markedly less empty space: boxes go around corners.
///
/// @param topOf  the scan, its ground, and how high surfaces go on above the region.
/// @return boxes of the cluster's class without a heading; empty for a cluster without returns.
std::vector<Obstacle> structureBoxes(const Cluster& cluster, SurfaceTops& topOf);

/// The same of several clusters, behind the boxes that are there. What lies in the upper half of the box of a road user
/// is a part of it, the top of a truck, and has none; nor has what is Unknown and lies in one.
void addStructureBoxes(const std::vector<Cluster>& clusters, SurfaceTops& topOf, std::vector<Obstacle>& boxes);

}  // namespace lidar_obstacles
