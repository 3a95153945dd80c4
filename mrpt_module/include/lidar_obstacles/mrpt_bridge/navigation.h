// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Obstacles as MRPT's navigation takes them: points, a 2D scan. (The grid map: toOccupancyGridMap() in maps.h.)
#pragma once

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What a robot must not run into.
struct NavigationOptions {
    bool everything = true;     ///< all that stands out of the ground in the region, walls and poles too; false: the
                                ///< obstacles' returns only
    double outline_step = 0.2;  ///< points along the outline of each box, so that its unseen sides are closed [m];
                                ///< 0: none
    int rays = 720;             ///< of the 2D scan, evenly over the full circle
    double scan_range = 40.0;   ///< of the 2D scan [m]
};

/// What CRobot2NavInterface::senseObstacles() is to give: points of obstacles in the vehicle frame [m], the outlines of
/// boxes at the height of their centres; structure that begins more than 2 m above the ground, what a vehicle passes
/// below, has none. Empty where nothing was found.
/// @throws std::invalid_argument if the result is not one of this cloud, or a number of the options is negative.
mrpt::maps::CSimplePointsMap toPointsMap(const PointCloud& cloud, const DetectionResult& result,
                                         const NavigationOptions& options = {});

/// A 2D scan around the vehicle's origin: along each ray, counter-clockwise from straight behind, the nearest of
/// returns and boxes (without what has no outline, as above), seen from above. Rays that meet nothing within
/// `scan_range` are marked invalid, with the range at its maximum. Rays inside a box see it at 0. Stamped as the cloud.
/// @throws std::invalid_argument as above, or if there are less than 3 rays.
mrpt::obs::CObservation2DRangeScan toVirtualScan(const PointCloud& cloud, const DetectionResult& result,
                                                 const NavigationOptions& options = {});

}  // namespace lidar_obstacles
