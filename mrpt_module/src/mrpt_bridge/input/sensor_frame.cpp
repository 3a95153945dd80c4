// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/sensor_frame.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace lidar_obstacles {

SensorFrame sensorFrame(const mrpt::poses::CPose3D& T_vehicle_sensor) {
    const Eigen::Matrix4d T = T_vehicle_sensor.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen();
    constexpr double kFarthest = 1e6;  // [m] beyond it a float has no room for a scan
    if (!T.allFinite() || T.cwiseAbs().maxCoeff() > kFarthest)
        throw std::runtime_error("the observation's sensorPose is not finite");
    SensorFrame frame;
    frame.rotation = T.topLeftCorner<3, 3>().cast<float>();
    frame.translation = T.topRightCorner<3, 1>().cast<float>();
    return frame;
}

RangeLimits rangeLimits(const SensorParams& params, double observation_min, double observation_max) {
    constexpr double kUnset = 1.0;  // what MRPT's classes begin with: its drivers and most recorders leave it so
    const double told_min = observation_min == kUnset ? 0.0 : observation_min;
    return {std::max(params.min_range, told_min), std::min(params.max_range, observation_max)};
}

std::vector<int> ringAfterDecimation(int rings, int planes) {
    std::vector<int> new_ring(static_cast<std::size_t>(std::max(rings, 0)), -1);
    if (planes < 0 || (planes > 0 && rings % planes != 0))
        throw std::invalid_argument("[sensor] planes = " + std::to_string(planes) + " does not divide the sensor's " +
                                    std::to_string(rings) + " planes");
    const int k = planes == 0 ? 1 : rings / planes;
    if (k == 0) return new_ring;  // no rings at all
    for (int ring = (k - 1) / 2, n = 0; ring < rings; ring += k) new_ring[static_cast<std::size_t>(ring)] = n++;
    return new_ring;
}

double secondsSinceEpoch(mrpt::system::TTimeStamp stamp) {
    return stamp == INVALID_TIMESTAMP ? 0.0 : mrpt::Clock::toDouble(stamp);
}

PointCloud emptyCloud(const SensorFrame& frame, mrpt::system::TTimeStamp stamp) {
    PointCloud cloud;
    cloud.timestamp = secondsSinceEpoch(stamp);
    cloud.sensor_origin = frame.translation;
    cloud.sensor_up = frame.rotation.col(2);
    return cloud;
}

}  // namespace lidar_obstacles
