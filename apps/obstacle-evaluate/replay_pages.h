// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Pages that play the worst scans.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/evaluate.h"
#include "lidar_obstacles/evaluation/worst_scans.h"
#include "lidar_obstacles/params.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// "replays/worst_01.html" for place 0.
std::string replayPageName(std::size_t place);

/// How the scans were found, and where pages go.
struct ReplayPagesOf {
    DetectorParams params;
    std::filesystem::path folder;  ///< that the names are relative to
};

/// Writes a page for each of the worst scans (`obstacle-replay --report` makes the same): the 20 scans before it and
/// the 10 after it. Where detections were given, they are shown; else what the detector finds, which begins 10 scans
/// earlier: its tracks have other numbers than in obstacles.csv.
/// @return the link to each scan in its page, relative to the folder; "" where the set has no rawlog, and from an
///     interruption (common/interrupt.h) on.
/// @throws as forEachScan; std::runtime_error if a page cannot be written.
std::vector<std::string> writeReplayPages(const std::vector<evaluation::WorstScan>& scans,
                                          const std::vector<evaluation::SetResult>& results,
                                          const EvaluateOptions& options, const ReplayPagesOf& of);

}  // namespace lidar_obstacles::apps
