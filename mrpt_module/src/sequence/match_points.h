// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The returns of a scan that are matched with earlier ones.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Speed and rate of turn of the vehicle in its own frame [m/s, rad/s].
struct Twist {
    Eigen::Vector3d speed = Eigen::Vector3d::Zero();
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
};

/// How the vehicle frame moves within so many seconds.
Eigen::Isometry3d moved(const Twist& twist, double seconds);
/// The twist that moves from `a` to `b`; @param seconds  above 0.
Twist twistBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double seconds);

/// One return that is matched.
struct MatchPoint {
    Eigen::Vector3f p;                                  ///< vehicle frame of its own instant [m]
    float offset = 0.0f;                                ///< that instant, after the middle of the scan [s]
    std::int32_t index = 0;                             ///< of the return
    Eigen::Vector2f tangent = Eigen::Vector2f::Zero();  ///< of the surface that goes on to both sides; else zero
};

struct MatchPoints {
    double time = 0.0;  ///< middle of the scan [s]
    std::vector<MatchPoint> points;
};

/// Some thousand returns, along each ring so far apart that near surfaces do not outweigh far ones.
/// @param apart  from one to the next on a ring [m].
MatchPoints matchPoints(const PointCloud& cloud, const OwnBody& own_body, float apart);

/// Where the points lie in the vehicle frame in the middle of the scan.
void straighten(const MatchPoints& scan, const Twist& twist, std::vector<Eigen::Vector3f>& straight);

}  // namespace lidar_obstacles
