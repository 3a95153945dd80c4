// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"
#include "objects/merge_tree.h"

namespace lidar_obstacles {

/// Pieces with what is in a box apart from what is not: whoever walks up to a wall is still there. Whether the parts
/// belong together is for the grouping to say. Parts of a few returns stay with the rest.
std::vector<Cluster> partedAtExpected(std::vector<Cluster> pieces, const PointCloud& cloud,
                                      const std::vector<ExpectedObject>& objects);

/// Sets `expected` of each hypothesis: the object whose box's returns it shares the most.
void lookForExpected(MergeTree& tree, const PointCloud& cloud, const std::vector<ExpectedObject>& objects);

/// What two of the tree together have of what is expected.
ExpectedMatch expectedOfUnion(const Hypothesis& a, const Hypothesis& b);

/// How much likelier it is that a hypothesis is whole than it would be by itself; 1 where nothing like it is expected.
float likelierWhole(const Hypothesis& h);

/// What this scan says of a hypothesis together with what was said of the object it is expected to be (Bayes): as much
/// as both cover the same returns. Sums to 1; `scan` itself where nothing like it is expected.
ClassProbabilities asExpected(const ClassProbabilities& scan, const Hypothesis& h);

}  // namespace lidar_obstacles
