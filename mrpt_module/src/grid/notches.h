// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Parts pieces where a ring runs into a notch that no one body has: seen from above bodies bulge outwards, so a return
/// that lies far behind the line between others of its ring, and beside which the ring jumps, is between two things:
/// the gap between parked cars, a person before a car. Below windows, that is: through these one looks into a body. The
/// grid closes such gaps; which parts are one object after all, e.g. bonnet and windscreen, is weighed later.
///
/// @param pieces  of returns of `cloud`.
/// @param height  of each return above the ground [m].
/// @return  the same returns in at least as many pieces, parts in place of their piece. Without a view: the pieces.
///     Left whole are those smaller than 2.5 m (a rider), of fewer than 10 returns, seen by several sensors, or with
///     returns more than 72 degrees to a side of their middle direction.
std::vector<Cluster> partedAtNotches(std::vector<Cluster> pieces, const PointCloud& cloud,
                                     const std::vector<float>& height);

}  // namespace lidar_obstacles
