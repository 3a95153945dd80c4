// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Truth about boxes and a ground known beforehand, for tests that begin behind the ground stage.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "support/synthetic_scene.h"

namespace lidar_obstacles::test {

inline double degrees(double rad) { return rad * 180.0 / M_PI; }

/// Angle between two directions that may be turned by a half circle [deg], 0 .. 90.
inline double headingError(double a, double b) { return degrees(std::abs(std::remainder(a - b, M_PI))); }

/// Horizontal distance from a point to the nearest point of the box [m]; 0 inside.
inline double distanceTo(const OrientedBox& box, const Eigen::Vector2d& from) {
    const Eigen::Vector2d d = Eigen::Rotation2Dd(-box.yaw) * (from - box.center.head<2>());
    const Eigen::Vector2d outside = (d.cwiseAbs() - 0.5 * box.size.head<2>()).cwiseMax(0.0);
    return outside.norm();
}

/// The ground z = 0, with no return on it: what the ground stage would tell of a cloud of obstacles.
inline GroundModel knownGround(const PointCloud& cloud) {
    GroundModel ground;
    ground.evidence = GroundEvidence::Good;
    ground.is_ground.assign(cloud.size(), 0);
    for (const Eigen::Vector3f& p : cloud.xyz) ground.height.push_back(p.z());
    return ground;
}

/// The same for a scan: returns on the ground are labelled.
inline GroundModel knownGround(const Scan& scan) {
    GroundModel ground = knownGround(scan.cloud);
    for (std::size_t i = 0; i < scan.hit.size(); ++i) ground.is_ground[i] = scan.hit[i] == kOnGround;
    return ground;
}

/// A cluster of the given returns with its heights.
inline Cluster clusterOf(const std::vector<std::int32_t>& points, const GroundModel& ground) {
    Cluster c;
    c.points = points;
    if (points.empty()) return c;
    const auto lower = [&](std::int32_t a, std::int32_t b) { return ground.height[a] < ground.height[b]; };
    c.bottom = ground.height[*std::min_element(points.begin(), points.end(), lower)];
    c.top = ground.height[*std::max_element(points.begin(), points.end(), lower)];
    return c;
}

/// All returns of a cloud: 0, 1, 2 ...
inline std::vector<std::int32_t> allReturns(const PointCloud& cloud) {
    std::vector<std::int32_t> all(cloud.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

inline bool isFinite(const OrientedBox& box) {
    return box.center.allFinite() && box.size.allFinite() && std::isfinite(box.yaw);
}

}  // namespace lidar_obstacles::test
