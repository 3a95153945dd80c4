// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The ground as one continuous surface: heights of nodes on circles around the sensor, between them interpolated.
#pragma once

#include <vector>

#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Sets the nodes of a model, its plane and its normal.
///
/// @param seeds  followGround(plane, seeds).
/// @param plane  of the whole scan, supported.
/// @param model  knows `center`.
/// Least squares over the nodes' heights, repeated: seeds near the surface of the round before, those that were reached
/// without a step, and what is known of any ground: it hardly bends from node to node and is not steep. Where there are
/// no seeds, the surface goes on as it came, more and more like the plane.
void fitSurface(const std::vector<GroundSeed>& seeds, const GroundPlane& plane, const GroundParams& params,
                GroundModel& model);

/// Sets the height of each return above the surface. Where the cloud has a view of one sensor, neighbours in a
/// column are in one direction if that is so to .3 degrees.
void measureHeights(const PointCloud& cloud, GroundModel& model);

}  // namespace lidar_obstacles
