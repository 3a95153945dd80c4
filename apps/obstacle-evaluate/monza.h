// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The paper's experiment (Sec. V): one vehicle over a lap, with 16 rings and decimated to 8.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/metrics.h"
#include "options.h"
#include "plots.h"

namespace lidar_obstacles::apps {

/// What one variant of the detector gave.
struct MonzaResult {
    std::string variant;
    evaluation::GroupMetrics target;
    std::vector<Plot> figures;  ///< one per set
    std::string worst_scans;    ///< HTML
};

/// Figures of a variant, `fig_<variant>.svg` and `.png` (with several sets `fig_<variant>_<set>`).
std::vector<Plot> plotFigures(const std::string& variant, const std::vector<evaluation::SetResult>& results,
                              const std::filesystem::path& folder);

/// Writes monza.json and monza.html, with the paper's own figures beside ours.
/// @throws std::runtime_error if they cannot be written.
void writeMonza(const std::vector<MonzaResult>& results, const EvaluateOptions& options);

/// The table for the terminal.
std::string monzaTable(const std::vector<MonzaResult>& results);

}  // namespace lidar_obstacles::apps
