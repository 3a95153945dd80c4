// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What an evaluation asks for.
#pragma once

#include "lidar_obstacles/evaluation/evaluate.h"

namespace lidar_obstacles::evaluation {

/// Whether a box's centre lies in the labelled sector and in the region.
bool isInRegion(const OrientedBox& box, const EvaluationOptions& options);

/// Whether an object has to be found: enough returns, near enough, inside the region.
bool isAskedFor(const TruthObject& object, const EvaluationOptions& options);

/// Whether a detection claims to be a road user, or whatever else `options` let count.
bool isClaim(const Detection& detection, const EvaluationOptions& options);

/// Detections a little beyond `max_range` may be objects that still count [m].
constexpr double kBeyondRange = 5.0;

}  // namespace lidar_obstacles::evaluation
