// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Zones as lines on the ground, for saved scenes and for the layers of a window.
#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CSetOfLines.h>

#include "lidar_obstacles/mrpt_bridge/scene_layers.h"

namespace lidar_obstacles {

constexpr mrpt::img::TColor kRegionColor{120, 170, 255};  ///< of the region and the vehicle's outline

/// Free green, occupied red, unknown yellow.
mrpt::img::TColor zoneColor(ZoneState state);
/// Adds a closed line on the ground; long sides follow it. Nothing without corners.
void drawOutline(const Outline& corners, const GroundModel& ground, mrpt::opengl::CSetOfLines& lines);
/// "ahead: occupied (returns)".
std::string textOf(const ZoneOutline& zone);
/// Where that text stands: the middle of the corners, on the ground.
Eigen::Vector3d labelPlace(const ZoneOutline& zone, const GroundModel& ground);

}  // namespace lidar_obstacles
