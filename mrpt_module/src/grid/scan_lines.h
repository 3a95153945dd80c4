// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"
#include "scan/label_sets.h"

namespace lidar_obstacles {

/// Joins labels along scan lines: neighbouring returns of one ring belong to one surface when the gap between them is
/// what a grazing surface leaves (it grows with range), also across a few missing returns.
///
/// @param points  returns to start from (indices into the cloud).
/// @param label_of_point  for each return of the cloud its label; -1: not to be joined.
void joinAlongScanLines(const PointCloud& cloud, const std::vector<std::int32_t>& points,
                        const std::vector<int>& label_of_point, const ClusteringParams& params, LabelSets& sets);

/// Puts the returns of each set of labels into one cluster, in the order of their first returns; those without a label
/// (-1) into none.
///
/// @param labels  how many there are.
std::vector<Cluster> clustersOfLabels(const std::vector<std::int32_t>& points, const std::vector<int>& label_of_point,
                                      LabelSets& sets, std::size_t labels);

}  // namespace lidar_obstacles
