// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What all observation converters share: the sensor's pose, the range limits, the choice of rings.
#pragma once

#include <mrpt/poses/CPose3D.h>
#include <mrpt/system/datetime.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Most rings any sensor is believed to have: a larger ring number means damaged data.
constexpr int kMaxRings = 128;

/// Is it a time within a turn, from its beginning or its end? What is not is of another clock, or damage.
inline bool isTimeOfTurn(double seconds) { return std::abs(seconds) <= 1.0; }

/// Pose of the sensor in the vehicle, as the float arithmetic of a scan wants it.
struct SensorFrame {
    Eigen::Matrix3f rotation;     ///< R_vehicle_sensor
    Eigen::Vector3f translation;  ///< [m]

    Eigen::Vector3f toVehicle(const Eigen::Vector3f& p_sensor) const { return rotation * p_sensor + translation; }
};

/// @throws std::runtime_error if any part of the pose is not finite.
SensorFrame sensorFrame(const mrpt::poses::CPose3D& T_vehicle_sensor);

/// Range limits, both ends included [m].
struct RangeLimits {
    double min;
    double max;

    bool contains(double range) const { return range >= min && range <= max; }
};

/// The stricter of the parameters' and the observation's limits, unless the latter's lower one is what MRPT's classes
/// begin with (1 m), which no driver has set. A limit of zero is kept out by the callers: a
/// range of zero means no return.
RangeLimits rangeLimits(const SensorParams& params, double observation_min, double observation_max);

/// New number of each of a sensor's rings when only `planes` of them are kept: -1 = dropped. `planes == 0` keeps all.
/// With k = rings / planes, rings (k - 1) / 2, + k, + 2 k ... stay.
/// @throws std::invalid_argument if `rings` is no multiple of `planes`.
std::vector<int> ringAfterDecimation(int rings, int planes);

/// Seconds since the epoch; 0 for an observation without a stamp.
double secondsSinceEpoch(mrpt::system::TTimeStamp stamp);

/// An empty cloud with stamp, sensor origin and sensor axis filled in.
PointCloud emptyCloud(const SensorFrame& frame, mrpt::system::TTimeStamp stamp);

}  // namespace lidar_obstacles
