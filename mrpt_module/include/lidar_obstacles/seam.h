// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The seam of a scan: its first and its last returns are neighbours in space and a turn apart in time.
#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What was found at the seam. `rings == 0`: no upright surface torn apart.
struct SeamGap {
    int rings = 0;                    ///< rings that show it
    double gap = 0.0;                 ///< how much farther away the late part is, along the line of sight [m]
    std::vector<std::int32_t> early;  ///< returns of the part seen first, from the seam on
    std::vector<std::int32_t> late;   ///< of the part seen a turn later
    double early_share = 0.5;         ///< of the returns of both parts, the ground before them left out
};

/// Looks for one upright surface across the seam whose two parts are apart along the line of sight, because it moved
/// relative to the frame of the cloud in the meantime: what leads at the vehicle's speed in a de-skewed scan, what
/// stands still in one that is not.
///
/// Two rings or more must show the same gap, up to 3.5 m. It is the edge of something before a background, and no
/// gap, where the far side goes on behind the near one: a ring that passes above it meets the far range.
/// @return nothing for clouds without rings or point times.
SeamGap findSeamGap(const PointCloud& cloud);

/// Closes the gap: both parts move to where the whole was at the mean time of its returns, which is what any other
/// obstacle's place means; along the vehicle's axis if they are ahead or behind, else along the line of sight. Rings,
/// columns and times stay.
PointCloud mendSeam(PointCloud cloud, const SeamGap& seam);

}  // namespace lidar_obstacles
