/// @file
/// The detector under test, and the scans it is given.
#pragma once

#include <functional>
#include <string>

#include "common/input_choice.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// What the detector says of one scan without its history: every stage, for pictures.
DetectionResult detectScan(const PointCloud& cloud, const DetectorParams& params);

/// The lidar of a recording that is meant.
struct LidarInput {
    std::string rawlog;
    InputChoice choice;
};

/// Called for each scan with its number, from 0, and the share of the file that was read; false ends the reading.
using ScanVisitor = std::function<bool(std::size_t, const SourceItem&, double)>;

/// Poses of the vehicle that come with the scans.
struct PosesOnTheWay {
    EgoSource source;     ///< which; none by default
    PoseFeed::Sink take;  ///< is given those that belong to a scan before the scan
};

/// Gives the scans of one lidar, or of several joined ones, to `visit`, in order. Scans whose points are missing have
/// their number, but are not given.
/// @return what the source left out, in one line; empty if nothing.
/// @throws std::runtime_error naming the file if it cannot be opened, is damaged, has several lidars and no label, or
///     no scan.
std::string forEachScan(const LidarInput& input, const ScanVisitor& visit, const PosesOnTheWay& poses = {});

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
