// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// OccupancyGrid <-> MRPT's grid map. MRPT stores the probability of a cell being **free**; here the two meet.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <optional>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Where the states of a cell begin, as probabilities of being occupied (ROS map_server's defaults).
struct OccupancyThresholds {
    double occupied = 0.65;  ///< at least this: Occupied
    double free = 0.196;     ///< at most this: Free; Unknown in between
};

/// The grid as an MRPT map: same corner, same cells; p(free) = 0 where occupied, 1 where free (which MRPT clamps to
/// 0.0004 and 0.9996) and 0.5 where unknown. The corner need not be a multiple of the resolution, although
/// COccupancyGridMap2D::setSize() would move it there; resizing the map later keeps what is in it only if it is.
///
/// @return a map without cells for a grid without cells.
mrpt::maps::COccupancyGridMap2D toOccupancyGridMap(const OccupancyGrid& grid);

/// An MRPT map, e.g. another mapper's, as a grid; `place_of_candidate` stays empty. MRPT keeps a cell in
/// 8 bits: a probability near a threshold is known to 0.01 only.
///
/// @param map  its frame is taken for the vehicle frame [m].
/// @throws std::invalid_argument unless 0 <= free < occupied <= 1.
OccupancyGrid fromOccupancyGridMap(const mrpt::maps::COccupancyGridMap2D& map,
                                   const OccupancyThresholds& thresholds = {});

/// The chain grid -> boxes on any MRPT grid map (Sec. III, Fig. 2), with the default thresholds; for others, for
/// instance when the map holds little more than one scan, convert it with fromOccupancyGridMap() first.
///
/// @param map     in the vehicle frame of the scan [m].
/// @param cloud   the scan that belongs to it, vehicle frame [m].
/// @param ground  its ground; segmented from the cloud where none is given.
/// @throws std::invalid_argument if a parameter is out of range.
DetectionResult detectOnGrid(const mrpt::maps::COccupancyGridMap2D& map, const PointCloud& cloud,
                             const std::optional<GroundModel>& ground, const DetectorParams& params);

}  // namespace lidar_obstacles
