// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Classes, tracks and velocities in metrics.json.
#pragma once

#include <nlohmann/json.hpp>

#include "lidar_obstacles/evaluation/tracking_result.h"

namespace lidar_obstacles::apps {

/// Adds `boxes_per_scan`, `blind` and `by_class` (vehicle, pedestrian, cyclist, person: those that were asked for).
/// What nothing was counted of is null. Where ids repeat within a scan, `tracks_missing` says so and the figures of
/// tracks are left out.
void addTracking(const evaluation::TrackingResult& result, nlohmann::ordered_json& json);

}  // namespace lidar_obstacles::apps
