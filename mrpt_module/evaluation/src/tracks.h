// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/evaluation/metrics.h"

namespace lidar_obstacles::evaluation {

/// Adds how long the ids of one set lasted.
void addTracks(const SetResult& set, TrackMetrics& tracks);

}  // namespace lidar_obstacles::evaluation
