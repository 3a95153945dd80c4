// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/beams.h"
#include "lidar_obstacles/features.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"
#include "objects/footprint.h"

namespace lidar_obstacles {

/// Hypotheses, what each covers seen from above, and what was measured of each once they are scored; in the same order.
struct MergeTree {
    std::vector<Hypothesis> hypotheses;
    std::vector<Footprint> footprints;
    std::vector<FeatureVector> features;
};

/// What may be one object: each piece, and pieces joined nearest first (single linkage; Hu, Held, Ramanan 2020). Two
/// pieces are joined unless both together are larger than any vehicle.
///
/// "Near" is told as the scan could have resolved it: across the line of sight as it is; along it by the rise of a
/// surface that leans as a windscreen does, for that is what a beam of the next ring up would have met in between.
///
/// @return the hypotheses, parts before wholes: first one for each piece, in their order; then what is made of two.
/// `gap`, `next_gap`, `part`, `parent`, `pieces`, `hanging` and `points` are set.
MergeTree mergeTree(const std::vector<Cluster>& pieces, const Beams& beams, const GroupingParams& params);

/// How near two groups are, as the scan could have resolved it [m]; very far where both together are larger than any
/// vehicle.
float linkBetween(const Footprint& a, const Footprint& b, const PointCloud& cloud, const GroupingParams& params);

}  // namespace lidar_obstacles
