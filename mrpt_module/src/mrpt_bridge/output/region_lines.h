// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is searched and what is not, as lines on the ground.
#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CSetOfLines.h>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

constexpr mrpt::img::TColor kExcludedColor{230, 120, 60};  ///< of places that are not searched

/// Adds the outline that is searched: `region.outline`, or the rectangle where there is none.
/// @throws std::invalid_argument if the outline is not right.
void drawSearched(const RegionParams& region, const GroundModel& ground, mrpt::opengl::CSetOfLines& lines);

/// Adds the outlines of `region.excluded`; a sector is drawn from the origin to the rectangle. Nothing where there are
/// none. @throws std::invalid_argument if they are not right.
void drawExcluded(const RegionParams& region, const GroundModel& ground, mrpt::opengl::CSetOfLines& lines);

}  // namespace lidar_obstacles
