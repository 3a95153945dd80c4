// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Morphology and connected components: the pieces of Fig. 2 (Mentasti et al., Sec. III.A), tight on purpose.
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// How many cells apart at most the closing makes occupied cells neighbours, at least 1.
///
/// @param range  of the cell from the sensor [m]: the reach grows with it.
/// @param resolution  cell size [m].
int closingReach(double range, double resolution, const ClusteringParams& params);

/// Closes the occupied cells, finds connected components, and joins components that a scan line shows to be one
/// surface seen at a grazing angle.
///
/// @param candidates  returns in the order of `grid.place_of_candidate`.
/// @return the components with their returns; empty where no cell is occupied.
std::vector<Cluster> clusterCells(const OccupancyGrid& grid, const PointCloud& cloud,
                                  const std::vector<std::int32_t>& candidates, const ClusteringParams& params);

}  // namespace lidar_obstacles
