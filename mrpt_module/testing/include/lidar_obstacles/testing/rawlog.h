// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The detector on a recording, for unit tests: one call, all obstacles.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <limits>
#include <string>
#include <vector>

#include "lidar_obstacles/motion.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::testing {

/// What of a recording is processed, and how. The defaults: every scan of its only lidar, poses from the recording.
struct RawlogOptions {
    DetectorParams params;  ///< from a file: loadParams("config.ini")
    /// Of the lidar; empty: there is one only. "front,rear" or "all": several as one (JoinedLidars).
    std::string sensor_label;
    std::size_t from = 0;                                      ///< number of the first scan, counted from 0
    std::size_t to = std::numeric_limits<std::size_t>::max();  ///< number of the last scan
    /// Poses of the vehicle, world frame [m], whatever `params.ego.source` says; empty: those that it names.
    std::vector<StampedPose> poses;
    InputOptions input;  ///< port, sender and model of captures
};

/// What was found in one scan, vehicle frame.
struct ScanObstacles {
    std::size_t scan = 0;             ///< number in the recording, counted from 0
    double timestamp = 0.0;           ///< of the scan's first firing [s since the epoch]
    std::vector<Obstacle> obstacles;  ///< empty where nothing was found
};

/// All scans that were asked for, in their order; never empty.
using RawlogResult = std::vector<ScanObstacles>;

/// Runs the detector over a rawlog or a capture as obstacle-replay does: poses are read ahead of their scans, tracks go
/// from scan to scan (unless `params.tracking.enabled` is off).
/// @throws std::runtime_error naming the file if it cannot be read, is damaged, or holds no scan that was asked for;
///     std::invalid_argument if it has several lidars and none was chosen, or a parameter is out of range.
RawlogResult detectRawlog(const std::string& path, const RawlogOptions& options = {});

/// "scan 3, 12 obstacles", for GoogleTest's messages.
void PrintTo(const ScanObstacles& scan, std::ostream* os);

}  // namespace lidar_obstacles::testing
