// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is constant over a scan for each of the 32 returns of a packet block.
#pragma once

#include <array>
#include <cstdint>

#include "mrpt_bridge/input/sensor_frame.h"
#include "mrpt_bridge/input/velodyne_timing.h"

namespace lidar_obstacles {

/// Geometry, time and limits of one return of a block. With d the corrected distance and A, B the block's horizontal
/// axes in the vehicle frame (A along the block's azimuth, B a quarter turn on in the sensor's sense of rotation) the
/// return lies at translation + (d a + a0) A + (d b + b0) B + (d c + c0) Z: the laser's elevation, its offsets and
/// the azimuth it turned on since the block's stamp are all in the six numbers.
struct ReturnModel {
    float a, a0, b, b0, c, c0;
    float distance_correction;  ///< [m]
    float time;                 ///< after the block's first firing [s]
    std::uint16_t raw_min;      ///< accepted raw distances, both included; raw_min > raw_max: none
    std::uint16_t raw_max;
    std::uint16_t ring;  ///< after decimation
    int column;          ///< of the view, counted from the block's azimuth on; 0 .. columns - 1
};

/// Everything that decoding a block needs besides the block.
struct VelodyneModel {
    std::array<ReturnModel, mrpt::obs::CObservationVelodyneScan::SCANS_PER_BLOCK> returns;
    SensorFrame frame;
    FiringTimes times;
    double azimuth_step = 0.0;  ///< of one block [0.01 deg]
    int rings = 0;              ///< after decimation
    int columns = 0;            ///< firings in a full turn
};

/// @throws std::runtime_error if calibration or sensor pose cannot be used,
///         std::invalid_argument if the parameters do not fit the sensor's rings.
VelodyneModel velodyneModel(const mrpt::obs::CObservationVelodyneScan& scan, const SensorParams& params);

/// Ring of each laser: the rank of its elevation, 0 = lowest.
std::vector<int> ringOfLaser(const mrpt::obs::VelodyneCalibration& calibration);

}  // namespace lidar_obstacles
