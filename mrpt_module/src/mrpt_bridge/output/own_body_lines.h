// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The vehicle's own body in saved scenes and in the layers of a window.
#pragma once

#include <mrpt/opengl/CSetOfLines.h>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Lines for the own body, called `own_body`, light blue; none yet.
mrpt::opengl::CSetOfLines::Ptr ownBodyLines();

/// Replaces the lines by the edges of the parts. A part without heights is drawn from the ground to 1.5 m above it.
void drawOwnBody(const OwnBody& body, const GroundModel& ground, mrpt::opengl::CSetOfLines& lines);

}  // namespace lidar_obstacles
