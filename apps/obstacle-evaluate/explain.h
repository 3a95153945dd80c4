// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What became of the returns of an object.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// Indices of the returns in the box, grown by 0.1 m.
std::vector<std::int32_t> returnsIn(const OrientedBox& box, const PointCloud& cloud);

/// Lines for people: how many returns lie in the box (grown by 0.1 m), how many of them were taken for ground, how
/// many are in which obstacle, and which clusters on it were sorted out, with reason, measure and limit.
std::vector<std::string> explainReturns(const OrientedBox& box, const PointCloud& cloud, const DetectionResult& result);

}  // namespace lidar_obstacles::apps
