// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Is a return listed in the view of its cloud, and not a further one of the same beam? Of a cloud with a view.
inline bool isListed(const PointCloud& cloud, std::int32_t i) {
    return cloud.view.at(cloud.ring[i], cloud.view.column_of[i]) == i;
}

}  // namespace lidar_obstacles
