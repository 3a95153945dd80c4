#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/beams.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/recognizer.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Gives each hypothesis its class probabilities and how probable it is a whole object (`probability`, `whole`).
void score(std::vector<Hypothesis>& tree, const Beams& beams, const GroundModel& ground, const Recognizer& recognizer);

/// What a verdict says of a hypothesis: `probability` and `whole`.
void setScore(Hypothesis& hypothesis, const CategoryProbabilities& verdict);

/// Marks the best cut of the tree: hypotheses that share no returns, hold all of them, and together have the most
/// returns in whole objects. By dynamic programming from the pieces up, in linear time (Hu, Held, Ramanan 2020).
void chooseBestCut(std::vector<Hypothesis>& tree);

}  // namespace lidar_obstacles
