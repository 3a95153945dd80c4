// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How soon a thing touches the vehicle if both go on as they do.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "lidar_obstacles/motion.h"
#include "sequence/zone_shape.h"

namespace lidar_obstacles {

/// How the vehicle moves over ground.
struct VehicleMotion {
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< vehicle axes [m/s]
    double turn_rate = 0.0;                              ///< to the left [rad/s]
};

/// By the poses of the last part of a second before `time`; none where they do not tell.
std::optional<VehicleMotion> vehicleMotion(const Trajectory& trajectory, double time);

/// A thing on the ground as the vehicle sees it now.
struct MovingThing {
    Outline outline;                                     ///< vehicle frame [m]
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< over ground, vehicle axes [m/s]
};

/// When the two outlines are `margin` [m] apart or nearer, up to `limit` [s]; none if they are not until then. The
/// vehicle goes on with the same speed on the same curve, the thing straight on and does not turn.
std::optional<double> timeToContact(const ZonePolygon& vehicle, const VehicleMotion& motion, const MovingThing& thing,
                                    const Eigen::Vector2d& margin_and_limit);

}  // namespace lidar_obstacles
