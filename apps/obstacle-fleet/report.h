// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the databases say, as pages to read.
#pragma once

#include <filesystem>

#include "drift.h"

namespace lidar_obstacles::fleet {

/// Writes report.html (over all, drift, failures, strangest scans, each recording) from fleet.sqlite, and timings.html
/// (slowest scans and recordings) from timings.sqlite, beside them.
/// @param drift  null: there is no baseline.
/// @throws std::runtime_error naming the file.
void writeReports(const std::filesystem::path& folder, const Drift* drift);

}  // namespace lidar_obstacles::fleet
