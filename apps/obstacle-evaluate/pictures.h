// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Pictures of scans, with the truth drawn in.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/evaluate.h"
#include "lidar_obstacles/evaluation/worst_scans.h"
#include "lidar_obstacles/params.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// What can be shown of one scan; pictures are JPEGs as base64.
struct ScanPictures {
    std::string overview;                ///< from behind the vehicle
    std::string close_up;                ///< the object that failed most, seen from the vehicle's side
    std::vector<std::string> remarks{};  ///< what became of its returns, where our detector was run
};

/// The detections of a set that were judged in a scan, as obstacles with their returns.
std::vector<Obstacle> judgedObstacles(const evaluation::SetResult& result, int scan_index, const PointCloud& cloud);

/// Draws the scans as the detector sees them - where detections were given, those - and the truth's boxes in green:
/// thick the object that failed most. One entry per scan; empty pictures where the set has no rawlog,
/// and from an interruption (common/interrupt.h) on.
/// @throws std::runtime_error as forEachScan, or if off-screen rendering is not available.
std::vector<ScanPictures> drawScans(const std::vector<evaluation::WorstScan>& scans,
                                    const std::vector<evaluation::SetResult>& results, const EvaluateOptions& options,
                                    const DetectorParams& params);

}  // namespace lidar_obstacles::apps
