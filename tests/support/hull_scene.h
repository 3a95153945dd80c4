// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the 8-plane algorithm is given: cells and returns of constructed outlines, and of objects in a scan.
#pragma once

#include <array>
#include <set>
#include <utility>

#include "lidar_obstacles/hull_fit.h"
#include "lidar_obstacles/occupancy_grid.h"
#include "support/box_geometry.h"

namespace lidar_obstacles::test {

/// The centres of the cells that the points fall into, each once, as addCells tells them.
inline std::vector<Eigen::Vector2f> cellsAt(const std::vector<Eigen::Vector2d>& points, double resolution) {
    std::set<std::pair<int, int>> cells;
    for (const Eigen::Vector2d& p : points)
        cells.insert(
            {static_cast<int>(std::floor(p.y() / resolution)), static_cast<int>(std::floor(p.x() / resolution))});
    std::vector<Eigen::Vector2f> centers;
    for (const auto& [row, col] : cells)
        centers.push_back((resolution * Eigen::Vector2d(col + 0.5, row + 0.5)).cast<float>());
    return centers;
}

/// Points every centimetre from `from` to `to`, both included.
inline std::vector<Eigen::Vector2d> lineOf(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const int steps = std::max(1, static_cast<int>(std::lround((to - from).norm() / 0.01)));
    std::vector<Eigen::Vector2d> points;
    for (int k = 0; k <= steps; ++k) points.emplace_back(from + (to - from) * k / steps);
    return points;
}

/// The hull fit of an outline whose returns all lie 1 m above the ground.
inline Obstacle fitOutline(const std::vector<Eigen::Vector2d>& outline, const DetectorParams& params = {},
                           const Eigen::Vector2d& sensor = Eigen::Vector2d::Zero()) {
    PointCloud cloud = cloudOf({});
    cloud.sensor_origin.head<2>() = sensor.cast<float>();
    for (const Eigen::Vector2d& p : outline)
        cloud.xyz.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 1.0f);
    const GroundModel ground = knownGround(cloud);
    Cluster cluster = clusterOf(allReturns(cloud), ground);
    cluster.cells = cellsAt(outline, params.grid.fine_resolution);
    return fitHullBox(cluster, cloud, ground, {params.hull_fit, params.box});
}

/// Corners of a box seen from above, counter-clockwise from front left.
inline std::array<Eigen::Vector2d, 4> cornersOf(const OrientedBox& box) {
    const Eigen::Rotation2Dd turn(box.yaw);
    std::array<Eigen::Vector2d, 4> corners;
    const double u[4] = {0.5, -0.5, -0.5, 0.5};
    const double v[4] = {0.5, 0.5, -0.5, -0.5};
    for (int k = 0; k < 4; ++k)
        corners[k] = box.center.head<2>() + turn * Eigen::Vector2d(u[k] * box.size.x(), v[k] * box.size.y());
    return corners;
}

/// A face of a box that is turned to the sensor.
struct SeenFace {
    Face face = kFront;
    double length = 0.0;  ///< [m]
    double angle = 0.0;   ///< that it takes up in the sensor's view [rad]
};

inline std::vector<SeenFace> seenFaces(const OrientedBox& box,
                                       const Eigen::Vector2d& sensor = Eigen::Vector2d::Zero()) {
    constexpr Face kFaces[4] = {kLeft, kBack, kRight, kFront};  // from corner k to corner k + 1
    const auto corners = cornersOf(box);
    std::vector<SeenFace> seen;
    for (int k = 0; k < 4; ++k) {
        const Eigen::Vector2d a = corners[k] - sensor;
        const Eigen::Vector2d b = corners[(k + 1) % 4] - sensor;
        const double turn = a.x() * b.y() - a.y() * b.x();
        if (turn < 0.0) seen.push_back({kFaces[k], (b - a).norm(), std::atan2(-turn, a.dot(b))});
    }
    return seen;
}

/// The only object of a world, its returns and cells, and the box fitted to them.
struct HullView {
    OrientedBox truth;
    Scan scan;
    GroundModel ground;
    Cluster cluster;
    Obstacle found;
};

inline HullView lookAt(const OrientedBox& box, const Sensor& sensor, const DetectorParams& params = {}) {
    World world = flatWorld();
    world.boxes = {box};
    HullView view{box, castRays(world, sensor), {}, {}, {}};
    view.ground = knownGround(view.scan);
    const auto candidates = cropToRegion(view.scan.cloud, view.ground, params.region);
    const OccupancyGrid grid = buildFineGrid(view.scan.cloud, candidates, view.ground, {params.region, params.grid});
    view.cluster = clusterOf(view.scan.returnsOn(0), view.ground);
    view.cluster = addCells({view.cluster}, view.scan.cloud, view.ground, grid)[0];
    view.found = fitHullBox(view.cluster, view.scan.cloud, view.ground, {params.hull_fit, params.box});
    return view;
}

/// Angle between the axes of two rectangles [deg], 0 .. 45.
inline double axisError(double a, double b) { return degrees(std::abs(std::remainder(a - b, M_PI / 2))); }

}  // namespace lidar_obstacles::test
