// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Decoder of raw Velodyne packets (VLP-16, HDL-32E).
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles {

/// Decodes `scan.scan_packets` (see toPointCloud); `point_cloud` is not looked at.
PointCloud decodePackets(const mrpt::obs::CObservationVelodyneScan& scan, const SensorParams& params,
                         DecodeStats& stats);

}  // namespace lidar_obstacles
