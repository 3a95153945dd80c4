// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// objects.csv and matches.csv: where the figures of metrics.json come from.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/evaluate.h"

namespace lidar_obstacles::apps {

/// One row per object that was asked for at least once, in the order of sets and scans: how often it was asked for
/// and found, means of its errors ("" where it was never found).
std::string objectsCsv(const std::vector<evaluation::SetResult>& sets);

/// One row per object and scan, also those not asked for (counted = 0): truth, detection and errors.
std::string matchesCsv(const std::vector<evaluation::SetResult>& sets);

}  // namespace lidar_obstacles::apps
