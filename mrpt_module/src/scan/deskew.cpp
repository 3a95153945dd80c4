// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/deskew.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr double kStep = 2e-4;       // between two poses [s]
constexpr double kLongestScan = 10;  // a sensor that turns slower than this is none [s]

/// For each step of the scan: from the vehicle frame of that instant to that of the reference time.
struct Motion {
    double first = 0.0;  ///< offset of step 0 [s]
    std::vector<Eigen::Affine3f> T_ref_now;
    PoseFound poses = PoseFound::At;

    const Eigen::Affine3f& at(float offset) const {
        const auto last = static_cast<int>(T_ref_now.size()) - 1;
        const auto per_second = static_cast<float>(1.0 / kStep);
        const int step = std::min(last, static_cast<int>((offset - static_cast<float>(first)) * per_second));
        return T_ref_now[static_cast<std::size_t>(step)];
    }
};

Motion motionOf(const PointCloud& cloud, const Trajectory& trajectory) {
    const auto [low, high] = std::minmax_element(cloud.time_offset.begin(), cloud.time_offset.end());
    Motion motion;
    motion.first = std::floor(*low / kStep) * kStep;
    const PoseAt reference = trajectory.at(cloud.timestamp);
    motion.poses = reference.found;
    if (!reference.T_world_vehicle || !(*high - *low < kLongestScan)) return motion;
    const Eigen::Isometry3d T_ref_world = reference.T_world_vehicle->inverse();
    const auto steps = static_cast<std::size_t>((*high - motion.first) / kStep) + 1;
    for (std::size_t k = 0; k < steps; ++k) {
        const double offset = motion.first + (static_cast<double>(k) + 0.5) * kStep;
        // a scan that ends with the last pose must not need one beyond it
        const PoseAt now = trajectory.at(cloud.timestamp + std::clamp<double>(offset, *low, *high));
        motion.poses = now.found == PoseFound::At ? motion.poses : now.found;
        if (!now.T_world_vehicle) {
            motion.T_ref_now.clear();
            return motion;
        }
        motion.T_ref_now.emplace_back((T_ref_world * *now.T_world_vehicle).matrix().cast<float>());
    }
    return motion;
}

/// Of a joined cloud: each sensor to where it was in the middle of its own scan.
void moveSensors(const Motion& motion, PointCloud& cloud) {
    auto begin = cloud.time_offset.begin();
    for (SensorRays& sensor : cloud.sensors) {
        const auto end = cloud.time_offset.begin() + sensor.end;
        if (begin == end) continue;
        const auto [low, high] = std::minmax_element(begin, end);
        sensor.origin = motion.at(0.5f * (*low + *high)) * sensor.origin;
        begin = end;
    }
}

}  // namespace

Deskewed deskew(PointCloud cloud, const Trajectory& trajectory) {
    if (cloud.empty()) return {std::move(cloud), Deskewing::Done, PoseFound::At};
    if (cloud.time_offset.empty()) return {std::move(cloud), Deskewing::NoPointTimes, PoseFound::At};
    const Motion motion = motionOf(cloud, trajectory);
    if (motion.T_ref_now.empty()) return {std::move(cloud), Deskewing::NoMotion, motion.poses};
    moveSensors(motion, cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Affine3f& T = motion.at(cloud.time_offset[i]);
        cloud.xyz[i] = T.linear() * cloud.xyz[i] + T.translation();
    }
    return {std::move(cloud), Deskewing::Done, motion.poses};
}

}  // namespace lidar_obstacles
