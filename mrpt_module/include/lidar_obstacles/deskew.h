// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// De-skewing: a scan takes a tenth of a second, in which the vehicle moves and turns.
#pragma once

#include "lidar_obstacles/motion.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

enum class Deskewing : std::uint8_t {
    Done,
    NoPointTimes,  ///< the source does not tell when each return was measured
    NoMotion       ///< the poses do not cover the scan
};

/// A cloud and what was done to it: where `how` is not Done, nothing.
struct Deskewed {
    PointCloud cloud;
    Deskewing how = Deskewing::Done;
    PoseFound poses = PoseFound::At;  ///< the weakest pose that was used, or the reason why there was none
};

/// Moves each return to where it would have been measured from the vehicle's pose at `cloud.timestamp`, if its surface
/// stands still: p' = T_world_vehicle(timestamp)^-1 T_world_vehicle(timestamp + offset) p.
///
/// The poses are looked up every 0.2 ms: at 30 m/s and 60 deg/s that leaves 3 mm and 0.006 deg. Rings, columns and the
/// sensor's origin stay as they are; each sensor of a joined cloud is moved to where it was in the middle of its own
/// scan. All poses must be known, from the first return to the last.
/// @param cloud  vehicle frame of each return's own instant [m]; an empty one is Done.
Deskewed deskew(PointCloud cloud, const Trajectory& trajectory);

}  // namespace lidar_obstacles
