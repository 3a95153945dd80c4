// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where things are at a given time, seen from above.
#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "lidar_obstacles/simulation/scenario.h"
#include "lidar_obstacles/simulation/track.h"

namespace lidar_obstacles::simulation {

/// World frame.
struct PlanarPose {
    Eigen::Vector2d position = Eigen::Vector2d::Zero();
    double yaw = 0.0;
};

/// Drives through way-points along a track (Moving). The yaw is the direction of travel; where it waits it keeps the
/// last one, and without any travel it is that of the track.
/// Its const members may be called by several threads at a time.
class Path {
  public:
    /// @param lead  curve that is added to s, where the way-points count from another path's.
    /// @throws std::invalid_argument if there are no way-points or their times do not rise.
    Path(std::shared_ptr<const Track> track, const std::vector<Waypoint>& waypoints, const Curve& lead = Curve());

    PlanarPose at(double t) const;
    Eigen::Vector2d position(double t) const;
    /// s over time.
    const Curve& along() const { return s_; }
    bool isMoving(double t) const;

  private:
    std::optional<double> yawWithin(double t, double from, double to) const;
    double waitingYaw(std::size_t leg) const;

    std::shared_ptr<const Track> track_;
    Curve s_, d_, lead_;
    std::vector<double> times_;  ///< of the way-points
};

/// One pose for each scan.
struct PosePerScan {
    std::vector<PlanarPose> poses;
};

using Motion = std::variant<PlanarPose, Path, PosePerScan>;

/// Pose of a thing at time t, which lies in scan `scan`. Beyond its poses a PosePerScan keeps the last one.
PlanarPose poseOf(const Motion& motion, double t, std::size_t scan);

/// The poses that `grid` asks for around a vehicle at `ego`, of a box of this length and width: range by range, within
/// it bearing by bearing, within that yaw by yaw.
PosePerScan gridPoses(const Gridded& grid, const PlanarPose& ego, const Eigen::Vector2d& box);

}  // namespace lidar_obstacles::simulation
