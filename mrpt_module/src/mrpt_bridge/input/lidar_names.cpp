// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/lidar_names.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

using mrpt::poses::CPose3D;

/// True unless the two are a different place or look another way. A pose that is not finite is no other place.
bool isSamePlace(const CPose3D& a, const CPose3D& b) {
    constexpr double kFar = 0.1, kTurned = 10.0 * M_PI / 180.0;  // [m], [rad]
    const CPose3D between = b - a;
    const auto R = between.getRotationMatrix();
    const double cosine = 0.5 * (R(0, 0) + R(1, 1) + R(2, 2) - 1.0);
    return !(between.norm() > kFar) && !(cosine < std::cos(kTurned));
}

}  // namespace

std::string LidarNames::nameOf(const mrpt::obs::CObservation& scan) {
    const std::string class_name = scan.GetRuntimeClass()->className;
    CPose3D pose;
    scan.getSensorPose(pose);
    std::vector<Lidar>& lidars = lidars_[scan.sensorLabel];
    auto it = std::find_if(lidars.begin(), lidars.end(), [&](const Lidar& lidar) {
        return lidar.class_name == class_name && isSamePlace(lidar.T_vehicle_sensor, pose);
    });
    constexpr std::size_t kMost = 64;  // of a label; more is a pose that jumps about
    if (it == lidars.end() && lidars.size() == kMost) --it;
    if (it == lidars.end()) it = lidars.insert(lidars.end(), {class_name, pose});
    it->T_vehicle_sensor = pose;
    const auto number = it - lidars.begin() + 1;
    return scan.sensorLabel + (number == 1 ? "" : '#' + std::to_string(number));
}

}  // namespace lidar_obstacles
