// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/feature_extractor.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/recognizer.h"
#include "lidar_obstacles/types.h"
#include "objects/merge_tree.h"

namespace lidar_obstacles {

constexpr std::size_t kSpeck = 3;  ///< fewer returns have no shape

/// Does some of it hang, and some stand below?
inline bool isMixed(const Hypothesis& h) { return h.hanging > 0 && h.hanging < h.pieces; }

/// Gives each hypothesis its class probabilities and how probable it is a whole object, parts before wholes.
void score(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer);

/// What a verdict says of a hypothesis: `category`, `probability`, `whole` and `cut`. What hangs is one thing with what
/// stands below it only in a vehicle. @param tree  its parts, scored.
void setScore(Hypothesis& hypothesis, const CategoryProbabilities& verdict, const std::vector<Hypothesis>& tree);

/// How many more returns are in whole objects if a hypothesis is taken as one instead of as its two parts.
float gainOf(const Hypothesis& hypothesis, const std::vector<Hypothesis>& tree);

/// Marks the best cut of the tree: hypotheses that share no returns, hold all of them, and together have the most
/// returns in whole objects. By dynamic programming from the pieces up, in linear time (Hu, Held, Ramanan 2020).
void chooseBestCut(std::vector<Hypothesis>& tree);

/// Says of each chosen group once more what it is, now that it is known what stands about it. One that is no vehicle
/// after all loses what hangs: the best cut of its parts is chosen instead.
void judgeChosen(MergeTree& tree, const Recognizer& recognizer);

}  // namespace lidar_obstacles
