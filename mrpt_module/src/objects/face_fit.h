// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/params.h"
#include "objects/box.h"

namespace lidar_obstacles {

/// The orientation for which the outline of the points lies best on the two faces turned to the sensor, both at once
/// (after Zhang et al. 2017, "Efficient L-shape fitting"): coarse to fine search, then least squares.
///
/// Returns on flat surfaces (a hood seen from above) count little: they do not lie on a face.
Orientation fitSeenFaces(const CroppedCluster& cropped, const PlaneFitParams& params);

}  // namespace lidar_obstacles
