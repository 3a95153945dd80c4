// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "lidar_obstacles/simulation/random.h"
#include "lidar_obstacles/simulation/recording.h"

namespace lidar_obstacles::simulation {
namespace {

/// Names of the streams of noise.
enum Stream : std::uint64_t { kRtk = 101, kWheels = 102 };

std::uint64_t milliseconds(double time) { return static_cast<std::uint64_t>(std::llround(time * 1e3)); }

}  // namespace

std::vector<double> ticks(double from, double to, double period) {
    std::vector<double> times;
    for (auto k = static_cast<long>(std::ceil(from / period - 1e-9)); static_cast<double>(k) * period < to - 1e-9; ++k)
        times.push_back(static_cast<double>(k) * period);
    return times;
}

mrpt::obs::CObservationRobotPose::Ptr rtkPose(const World& world, double time, std::uint64_t seed) {
    constexpr double kLevel = 0.015, kHeight = 0.025, kAngle = 0.1 * M_PI / 180.0;  // standard deviations
    const Pose6 exact = egoPoses(world, {time, time + 0.01}).at(time);
    Random random(seed, kRtk, milliseconds(time));
    const double x = exact.position.x() + kLevel * random.gaussian();
    const double y = exact.position.y() + kLevel * random.gaussian();
    const double z = exact.position.z() + kHeight * random.gaussian();
    const double yaw = exact.yaw + kAngle * random.gaussian(), pitch = exact.pitch + kAngle * random.gaussian();
    const double roll = exact.roll + kAngle * random.gaussian();
    auto observation = mrpt::obs::CObservationRobotPose::Create();
    observation->sensorLabel = "ego_rtk";
    observation->timestamp = mrpt::Clock::fromDouble(kEpoch + time);
    observation->pose.mean = mrpt::poses::CPose3D(x, y, z, yaw, pitch, roll);
    observation->pose.cov.setZero();
    for (int k = 0; k < 6; ++k) {
        const double sigma = k < 2 ? kLevel : k == 2 ? kHeight : kAngle;
        observation->pose.cov(k, k) = sigma * sigma;
    }
    return observation;
}

WheelOdometry::WheelOdometry(const World& world, double start, std::uint64_t seed)
    : world_(world), time_(start), seed_(seed) {}

mrpt::obs::CObservationOdometry::Ptr WheelOdometry::at(double time) {
    constexpr double kScale = 1.006, kTurnScale = 1.01;     // wheels that are worn, a wheelbase that is not measured
    constexpr double kStepNoise = 0.01, kTurnNoise = 0.02;  // share of the distance; [rad] per square root of a metre
    const mrpt::poses::CPose2D before = [&] {
        const PlanarPose p = world_.ego.at(time_);
        return mrpt::poses::CPose2D(p.position.x(), p.position.y(), p.yaw);
    }();
    const PlanarPose now = world_.ego.at(time);
    const mrpt::poses::CPose2D step = mrpt::poses::CPose2D(now.position.x(), now.position.y(), now.yaw) - before;
    Random random(seed_, kWheels, steps_++);
    const double length = step.norm();
    const double stretch = kScale * (1.0 + kStepNoise * random.gaussian());
    const double turn = kTurnScale * step.phi() + 0.1 * kTurnNoise * std::sqrt(length) * random.gaussian();
    pose_ = pose_ + mrpt::poses::CPose2D(stretch * step.x(), stretch * step.y(), turn);
    auto observation = mrpt::obs::CObservationOdometry::Create();
    observation->sensorLabel = "odometry";
    observation->timestamp = mrpt::Clock::fromDouble(kEpoch + time);
    observation->odometry = pose_;
    if (time > time_) {
        observation->hasVelocities = true;
        observation->velocityLocal = {stretch * step.x() / (time - time_), stretch * step.y() / (time - time_),
                                      turn / (time - time_)};
    }
    time_ = time;
    return observation;
}

}  // namespace lidar_obstacles::simulation
