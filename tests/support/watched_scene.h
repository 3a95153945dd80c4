// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A vehicle that stands on the synthetic street, scan after scan: for tests of zones and health.
#pragma once

#include <optional>
#include <utility>

#include "lidar_obstacles/detector.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles::test {

/// Feeds a detector with scans ten times a second.
class WatchedScene {
  public:
    explicit WatchedScene(bool with_poses = true) : detector_(DetectorParams{}), with_poses_(with_poses) {}

    /// The next scan. @param x  where the vehicle is.
    SequenceResult next(PointCloud cloud, double x = 0.0) {
        time += period;
        cloud.timestamp = time;
        StampedPose pose;
        pose.time = time;
        pose.position.x() = x;
        if (with_poses_) detector_.addPose(pose);
        return detector_.process(std::move(cloud));
    }
    void losePoses() { with_poses_ = false; }
    const Trajectory& trajectory() const { return detector_.trajectory(); }

    double time = 1000.0;  ///< of the last scan [s]
    double period = 0.1;   ///< [s]

  private:
    ObstacleDetector detector_;
    bool with_poses_;
};

inline PointCloud scanOf(std::vector<OrientedBox> boxes) {
    return castRays(World{{GroundStrip{}}, std::move(boxes)}, Sensor{}).cloud;
}

}  // namespace lidar_obstacles::test
