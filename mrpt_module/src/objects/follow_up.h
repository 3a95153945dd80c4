// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Follows surfaces upwards from their returns, ring by ring, as long as the next return of the same azimuth lies
/// right above; also beyond the height up to which returns are candidates. Each return is passed once, however many
/// start below it.
class SurfaceTops {
  public:
    SurfaceTops(const PointCloud& scan, const GroundModel& g) : cloud(scan), ground(g) {}

    /// Height above the ground that the surface at a return reaches [m]. Of a cloud with a view.
    float operator()(std::int32_t i);

    const PointCloud& cloud;
    const GroundModel& ground;

  private:
    std::vector<float> top_;  ///< of each return, as far as known; made when first asked
};

}  // namespace lidar_obstacles
