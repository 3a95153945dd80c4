// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The measured features of one group of returns, for people who ask what the recognizer was told.
#pragma once

#include "lidar_obstacles/features.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// The features of a hypothesis that are measured, as the grouping measured them; those of what was thought of its
/// parts and neighbours (isOpinion) are zero. All zero for a cloud without rings, or a hypothesis without returns.
/// For many groups of a scan FeatureExtractor takes less time.
FeatureVector measuredFeatures(const Hypothesis& hypothesis, const PointCloud& cloud, const GroundModel& ground);

}  // namespace lidar_obstacles
