// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Takes back short runs of ground returns that stand a step above the ground beside them on the same ring: their
/// beams were cut short by metres although the height above the fitted surface is small. The step between neighbouring
/// returns does not depend on how well the surface fits, so this works where a single ring is all that hits an
/// obstacle. Clouds without a view are left as they are.
void keepStandingRuns(const PointCloud& cloud, GroundModel& model);

/// Takes back returns near the ground that carry something: the next ring above hits a steep surface right over them,
/// so they are its foot and not ground. What few rings leave of an obstacle is too little to lose a row.
void keepFeetOfObstacles(const PointCloud& cloud, GroundModel& model);

}  // namespace lidar_obstacles
