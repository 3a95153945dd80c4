// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Classes, tracks and velocities for people: in the terminal and in the report.
#pragma once

#include <string>

#include "lidar_obstacles/evaluation/tracking_result.h"

namespace lidar_obstacles::apps {

/// A few lines per group, of at most 150 characters; "" where no object was asked for.
std::string trackingText(const evaluation::TrackingResult& result);

/// The same as HTML tables.
std::string trackingHtml(const evaluation::TrackingResult& result);

}  // namespace lidar_obstacles::apps
