// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/ground.h"

#include <cmath>
#include <string>
#include <utility>

namespace lidar_obstacles::simulation {

Ground::Ground(Mesh mesh) : mesh_(std::move(mesh)) { top_ = boundsOf(mesh_.mesh()).max().z() + 1.0; }

std::optional<double> Ground::heightAt(const Eigen::Vector2d& place) const {
    const Eigen::Vector3f from(static_cast<float>(place.x()), static_cast<float>(place.y()), static_cast<float>(top_));
    const auto below = mesh_.distance(from, -Eigen::Vector3f::UnitZ(), 1e4f);
    if (!below) return std::nullopt;
    return top_ - static_cast<double>(*below);
}

Pose6 standOn(const Ground& ground, const PlanarPose& pose, const Stance& stance) {
    const Eigen::Vector2d ahead = 0.5 * stance.wheelbase * Eigen::Vector2d(std::cos(pose.yaw), std::sin(pose.yaw));
    const Eigen::Vector2d left = 0.5 * stance.gauge * Eigen::Vector2d(-std::sin(pose.yaw), std::cos(pose.yaw));
    const auto height = [&](const Eigen::Vector2d& offset) {
        const auto z = ground.heightAt(pose.position + offset);
        if (z) return *z;
        throw ScenarioError("something stands at (" + std::to_string(pose.position.x()) + ", " +
                            std::to_string(pose.position.y()) + "), beside the terrain; enlarge terrain.reach");
    };
    const double fl = height(ahead + left), fr = height(ahead - left), rl = height(left - ahead),
                 rr = height(-ahead - left);
    Pose6 result;
    result.position = {pose.position.x(), pose.position.y(), 0.25 * (fl + fr + rl + rr)};
    result.yaw = pose.yaw;
    if (stance.wheelbase > 0.0) result.pitch = std::atan2(0.5 * (rl + rr - fl - fr), stance.wheelbase);
    if (stance.gauge > 0.0) result.roll = std::atan2(0.5 * (fl + rl - fr - rr), stance.gauge);
    return result;
}

Eigen::Isometry3d toIsometry(const Pose6& pose) {
    return Eigen::Translation3d(pose.position) * Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(pose.pitch, Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(pose.roll, Eigen::Vector3d::UnitX());
}

}  // namespace lidar_obstacles::simulation
