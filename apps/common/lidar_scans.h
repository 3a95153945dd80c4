// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The scans of one lidar of a recording, one after another.
#pragma once

#include <functional>
#include <string>

#include "common/input_choice.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

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
/// @throws std::invalid_argument if the parameters do not fit the sensor; std::runtime_error with file, number of the
///     object and of the scan if it cannot be right.
PointCloud namedCloudOf(const LidarInput& input, std::size_t number, const SourceItem& scan,
                        const DetectorParams& params);

}  // namespace lidar_obstacles::apps
