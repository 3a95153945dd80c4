// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What obstacle-track reads: the boxes of each scan, and the poses of the vehicle.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/motion.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// One scan of a sequence.
struct ScanRows {
    int scan_index = 0;
    double timestamp = 0.0;            ///< [s]
    std::vector<Obstacle> boxes;       ///< vehicle frame
    std::vector<double> time_offsets;  ///< of each box: when it was seen, after the timestamp [s]
    std::size_t unseen = 0;            ///< rows left out: a tracker told them for what was hidden
};

/// The scans of EGO, rising, without boxes yet, and its poses.
/// @throws CsvError naming file and line; std::runtime_error if it cannot be read.
struct EgoRows {
    std::vector<ScanRows> scans;
    std::vector<StampedPose> poses;
};
EgoRows readEgo(const std::string& file);

/// The boxes of a detections file, put to the scans they belong to. Without scans these are made of the boxes.
/// @throws CsvError naming file and line; std::runtime_error if it cannot be read.
std::vector<ScanRows> readDetections(const std::string& file, std::vector<ScanRows> scans);

}  // namespace lidar_obstacles::apps
