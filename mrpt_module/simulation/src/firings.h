// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The firings of a turn and the rays of their lasers.
#pragma once

#include <array>
#include <vector>

#include "lidar_obstacles/simulation/lidar.h"

namespace lidar_obstacles::simulation {

/// One firing of all lasers.
struct Firing {
    double time;                       ///< of the first laser, since the start of the scenario [s]
    Eigen::Isometry3d T_world_sensor;  ///< where the sensor really is
};

std::vector<Firing> firingsOf(const World& world, const Turn& turn, const PoseTrack& ego);

/// T_vehicle_sensor: as mounted, the error included.
Eigen::Isometry3d mountedPose(const SensorSpec& sensor);

/// Unit direction of the shot of a laser of this elevation in the sensor's frame at time t.
Eigen::Vector3d directionOf(double elevation, double t, double rate);

/// How many shots would meet an object if there was nothing else.
int countAlone(const World& world, const std::vector<Firing>& firings, const WorldObject& object,
               const PoseTrack& poses);

}  // namespace lidar_obstacles::simulation
