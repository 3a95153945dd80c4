// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Zones, drawn into the scene of a scan.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/zones.h"

namespace lidar_obstacles {

/// Corners on the map in the vehicle's frame [m], at the vehicle's height: where zones of the map are drawn.
Outline seenFromVehicle(const Outline& map, const Eigen::Isometry3d& T_map_vehicle);

/// Adds an object `zones` to a scene made by toScene: the line around each zone on the ground, with its name and state;
/// green: free, red: occupied, yellow: unknown. Zones of the map are left out where the pose is not known. Blue: the
/// vehicle's outline, where it is told.
void addZones(mrpt::opengl::COpenGLScene& scene, const SequenceResult& found, const Trajectory& trajectory,
              const ZoneMonitor& zones);

}  // namespace lidar_obstacles
