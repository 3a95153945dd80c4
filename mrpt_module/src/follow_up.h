#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Follows a surface upwards from one of its returns, plane by plane, as long as the next return of the same azimuth
/// lies right above; also beyond the height up to which returns are candidates.
///
/// @param cloud  with a view.
/// @return the height it reaches above the ground [m].
float followUp(const PointCloud& cloud, const GroundModel& ground, std::int32_t start);

}  // namespace lidar_obstacles
