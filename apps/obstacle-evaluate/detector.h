// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The detector under test, and the scans it is given.
#pragma once

#include <functional>
#include <string>

#include "common/lidar_scans.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// What the detector says of one scan without its history: every stage, for pictures.
DetectionResult detectScan(const PointCloud& cloud, const DetectorParams& params);

/// The scan, with those beside it, as a point cloud.
PointCloud cloudOf(const SourceItem& scan, const DetectorParams& params);

/// How far a run of the detector came.
struct Progress {
    std::size_t scans = 0;
    double last_time = 0.0;    ///< timestamp of the last scan [s]; 0 without any
    std::string remarks;       ///< what the source left out
    bool interrupted = false;  ///< by a signal (common/interrupt.h); the file holds the scans before that
};

/// Runs the detector for sequences on all scans, with the recording's poses, and writes an obstacles.csv: tracks,
/// unless tracking is off.
/// @param progress  called with the share that is done.
/// @throws as forEachScan; std::runtime_error if the file cannot be written.
Progress writeDetections(const LidarInput& input, const DetectorParams& params, const std::string& csv,
                         const std::function<void(double)>& progress);

}  // namespace lidar_obstacles::apps
