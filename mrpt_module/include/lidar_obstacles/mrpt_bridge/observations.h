// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// From MRPT's lidar observations to the module's own point cloud.
///
/// All functions: returns in the vehicle frame (the observation's sensorPose applied) [m]; zero ranges, non-finite
/// coordinates and ranges outside both the parameters' and the observation's limits are dropped. Rings count from
/// the lowest elevation, 0; `SensorParams::planes` decimates and renumbers them 0 .. planes - 1. An observation
/// without returns gives an empty cloud. Nothing is printed.
///
/// Errors of all functions: std::invalid_argument where the parameters do not fit the sensor (rings that do not
/// divide its rings); std::runtime_error where the observation cannot be right (non-finite sensor pose, no or
/// unknown calibration, more packets than ten turns hold, fields of different lengths).
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <optional>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What is worth knowing of how a scan was read.
struct DecodeStats {
    int packets = 0;          ///< packets in the observation
    int retimed_packets = 0;  ///< clock more than half a second off the scan's median: their times are by their azimuth
    int damaged_blocks = 0;   ///< skipped: wrong block header or azimuth >= 360 deg
    bool without_rings = false;  ///< the scan names no rings, and its elevations do not tell them
    /// Times of no turn were left out, the returns have none: more than a second from the stamp, or the whole turn took
    /// less than 0 s.
    bool times_left_out = false;
};

/// Decodes the raw packets of a VLP-16 (or other 16-laser Velodyne of its timing), HDL-32E or VLP-32C: all 32 returns
/// of a block, single or dual return (equal distances of a pair are kept once). Azimuth and time are told for the
/// instant of each laser's own firing. Fills every field of PointCloud; `view` has one column per firing azimuth.
/// Without packets the observation's `point_cloud` is taken as it is: `laser_id` becomes the ring (without it: as in a
/// CObservationPointCloud), `time_offset` is filled where per-point stamps are there. Where returns are older than the
/// scan's stamp, the cloud is stamped by the first of them.
/// @param stats  if not null, receives what was skipped.
PointCloud toPointCloud(const mrpt::obs::CObservationVelodyneScan& scan, const SensorParams& params,
                        DecodeStats* stats = nullptr);

/// Any point map: rings, times after the scan's stamp or before it (the cloud is stamped by the first return), and
/// intensity (taken as 0 .. 1) where the map has them (rings and times need MRPT 2.11 or newer). Rings that the map
/// does not have, and the view, are recovered where the elevations of the points in the sensor's frame fall on steps,
/// as those of a turning lidar do that was not moved or corrected for its motion; otherwise there are none.
/// @param stats  if not null, receives whether there are rings.
/// @throws std::invalid_argument if `params.planes` asks for decimation and there are no rings.
PointCloud toPointCloud(const mrpt::obs::CObservationPointCloud& scan, const SensorParams& params,
                        DecodeStats* stats = nullptr);

/// A range image. The observation tells no elevations: they are those of its `lidarModel` (case, blanks and dashes do
/// not matter): VLP-16, Puck Hi-Res, VLP-32C and HDL-32E with rows in the laser's firing order, as MRPT's own converter
/// writes them, RS-LiDAR-16 and RS-Helios-16 from the lowest row, XT16 and XT32 from the highest. Returns have times
/// where `sweepDuration` is above 0.
/// @param stats  if not null, receives whether a duration of no turn was left out.
/// @throws std::runtime_error for other models.
PointCloud toPointCloud(const mrpt::obs::CObservationRotatingScan& scan, const SensorParams& params,
                        DecodeStats* stats = nullptr);

/// A planar scan: one ring, no times, no intensity. Its rays are `aperture` wide, the first and last at its ends.
PointCloud toPointCloud(const mrpt::obs::CObservation2DRangeScan& scan, const SensorParams& params);

/// One of the above by the observation's class; nullopt if it is no lidar scan.
/// @param stats  if not null, receives what is worth knowing.
std::optional<PointCloud> toPointCloud(const mrpt::obs::CObservation& observation, const SensorParams& params,
                                       DecodeStats* stats = nullptr);

/// True if toPointCloud(observation) gives a cloud.
bool isLidarScan(const mrpt::obs::CObservation& observation);

}  // namespace lidar_obstacles
