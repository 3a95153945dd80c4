// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Vertical plane -> heading -> 3D box (Mentasti et al., Sec. III.A, Fig. 3): the 16-plane algorithm's boxes.
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What the stage needs: how a plane is found, and how a box is made of it.
struct PlaneBoxParams {
    PlaneFitParams fit;
    BoxParams box;
};

/// Fits one vertical plane that faces the sensor (`plane_fit.method = plane`, the paper's: RANSAC, then least squares)
/// or both seen faces at once (`faces`) to the returns of one cluster, takes the heading from them and encloses the
/// returns in an upright box with them as its faces.
///
/// @param cluster  with `bottom` and `top` as sortGroups sets them: the box is as high as `top`.
/// @return a box without a heading where the returns support no plane (fewer than three, or all on one spot).
/// @throws std::invalid_argument for a cluster without returns.
Obstacle fitPlaneBox(const Cluster& cluster, const PointCloud& cloud, const GroundModel& ground,
                     const PlaneBoxParams& params);

/// fitPlaneBox for each cluster, in their order.
std::vector<Obstacle> fitPlaneBoxes(const PointCloud& cloud, const std::vector<Cluster>& clusters,
                                    const GroundModel& ground, const PlaneBoxParams& params);

}  // namespace lidar_obstacles
