// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/feature_extractor.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/recognizer.h"
#include "objects/merge_tree.h"

namespace lidar_obstacles {

/// Joins chosen hypotheses that the tree did not bring together where the score says that they are one object: the pair
/// that gains most first, as long as any gains. What is joined is added to the tree.
void joinChosen(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                const GroupingParams& params);

/// Joins what was judged a small piece of a vehicle or person to the chosen group with more returns of that kind that
/// it fits best, where both together are hardly several things. The verdict on the larger one holds for both.
void joinPieces(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                const GroupingParams& params);

}  // namespace lidar_obstacles
