// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// metrics.json: names and units as people who compare detectors know them.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "lidar_obstacles/evaluation/metrics.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// `recall`, `face_m`, `h180_deg` ... of one group; `ci95` holds the intervals. Statistics of nothing are {"n": 0}.
nlohmann::ordered_json toJson(const evaluation::GroupMetrics& metrics);

/// Millionths are enough, and read better.
double rounded(double value);

/// The whole table.
nlohmann::ordered_json toJson(const evaluation::Metrics& metrics);

/// What was asked, of which files, with which parameters.
nlohmann::ordered_json optionsJson(const EvaluateOptions& options, const Variant& variant);

}  // namespace lidar_obstacles::apps
