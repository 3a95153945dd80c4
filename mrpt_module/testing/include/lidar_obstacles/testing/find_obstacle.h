// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Looking for obstacles among those of a scan.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/testing/rawlog.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::testing {

/// The obstacles of whatever a detector gives back.
inline const std::vector<Obstacle>& obstaclesOf(const std::vector<Obstacle>& obstacles) { return obstacles; }
inline const std::vector<Obstacle>& obstaclesOf(const DetectionResult& result) { return result.obstacles; }
inline const std::vector<Obstacle>& obstaclesOf(const SequenceResult& result) { return result.detection.obstacles; }
inline const std::vector<Obstacle>& obstaclesOf(const ScanObstacles& scan) { return scan.obstacles; }

/// The obstacle of this class whose centre is nearest to (x, y), vehicle frame [m]; nullopt if none is within
/// `tolerance` [m]. @throws std::invalid_argument if the tolerance is not a positive number.
// NOLINTNEXTLINE(readability-function-size): reads as the matcher near(x, y, tolerance)
std::optional<Obstacle> findObstacle(const std::vector<Obstacle>& obstacles, ObstacleClass cls, double x, double y,
                                     double tolerance);

/// The same for the result of a detector: ScanObstacles, DetectionResult or SequenceResult.
template <typename Result>
// NOLINTNEXTLINE(readability-function-size): as above
std::optional<Obstacle> findObstacle(const Result& result, ObstacleClass cls, double x, double y, double tolerance) {
    return findObstacle(obstaclesOf(result), cls, x, y, tolerance);
}

/// One obstacle in a line: "vehicle 12 at (12.1, 3.0), 4.1 x 1.7 x 1.5 m, heading 88 deg, 154 returns".
std::string describe(const Obstacle& obstacle);

}  // namespace lidar_obstacles::testing
