// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/measured_features.h"

#include "lidar_obstacles/feature_extractor.h"
#include "objects/footprint.h"

namespace lidar_obstacles {

FeatureVector measuredFeatures(const Hypothesis& hypothesis, const PointCloud& cloud, const GroundModel& ground) {
    if (hypothesis.points.empty() || cloud.view.empty()) return {};
    const Beams beams(cloud);
    return FeatureExtractor(beams, ground)(hypothesis, footprintOf(hypothesis.points, cloud));
}

}  // namespace lidar_obstacles
