// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Convex hull on the fine grid -> visible sides -> heading -> 3D box (Mentasti et al., Sec. IV, Fig. 5): the boxes of
/// the algorithm for sensors of 8 rings or fewer.
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What the stage needs: how the visible sides are found, and how a box is made of them.
struct HullBoxParams {
    HullFitParams fit;
    BoxParams box;
};

/// Takes the heading from the convex hull of a cluster's cells, and size and centre from its returns:
///
/// * both dimensions of the hull exceed `two_sides`, and it has a right corner towards the sensor: two sides are seen.
///   The hull is near a triangle with the corners A and C at the far ends and B nearest to the sensor; D = A + C - B,
///   and the heading is the mean direction of the sides, modulo 90 degrees.
/// * else one side is seen: the heading is that of a line through the cells (RANSAC).
/// * both dimensions are below `person`: no heading.
///
///           C                 .  D        sides BA and BC are seen,
///            \      `  .  '  .            AD and CD are not
///             \         .
///              B-----A
///                o  sensor
///
/// @param cluster  with `bottom` and `top` as sortGroups and `cells` as addCells set them. Cells that are not set make
///         a box without a heading.
/// @return its `hull`, and in `marks` A, B, C, D or the two ends of the line. The height is what was hit: with few
///         rings the obstacle may be as high as `max_height`.
/// @throws std::invalid_argument for a cluster without returns.
Obstacle fitHullBox(const Cluster& cluster, const PointCloud& cloud, const GroundModel& ground,
                    const HullBoxParams& params);

/// fitHullBox for each cluster, in their order.
std::vector<Obstacle> fitHullBoxes(const PointCloud& cloud, const std::vector<Cluster>& clusters,
                                   const GroundModel& ground, const HullBoxParams& params);

}  // namespace lidar_obstacles
