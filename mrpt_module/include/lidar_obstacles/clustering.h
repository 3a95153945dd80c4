/// @file
/// Morphology, connected components and gates (Mentasti et al., Sec. III.A, Fig. 2).
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// How many cells apart at most the closing makes occupied cells neighbours, at least 1.
///
/// @param range  of the cell from the sensor [m]: the reach grows with it.
/// @param resolution  cell size [m].
int closingReach(double range, double resolution, const ClusteringParams& params);

/// Closes the occupied cells, finds connected components, and joins components that a scan line shows to be one
/// surface seen at a grazing angle.
///
/// @param candidates  returns in the order of `grid.place_of_candidate`.
/// @return the components with their returns; empty where no cell is occupied.
std::vector<Cluster> clusterCells(const OccupancyGrid& grid, const PointCloud& cloud,
                                  const std::vector<std::int32_t>& candidates, const ClusteringParams& params);

/// Takes apart components larger than a car on a finer grid: cars parked half a metre apart share neighbouring cells of
/// the occupancy grid, while a bus holds together along its scan lines.
std::vector<Cluster> splitOversized(std::vector<Cluster> components, const PointCloud& cloud,
                                    const ClusteringParams& params);

/// Takes what may be a vehicle out of components that are too tall for one: cars park under trees and at walls. Tall is
/// what a surface leads up from beyond `gates.max_top`. Sources without rings are returned unchanged.
std::vector<Cluster> splitFromTall(std::vector<Cluster> components, const PointCloud& cloud, const GroundModel& ground,
                                   const DetectorParams& params);

/// Takes apart two people side by side: an upright component as large as two, with a gap wider than what lies between
/// neighbouring beams and a person's size on either side of it.
std::vector<Cluster> splitPeople(std::vector<Cluster> components, const PointCloud& cloud, const GroundModel& ground);

/// Joins components that are pieces of one vehicle: planes pass over the hood and hit the windscreen a metre behind, so
/// that few planes leave a bumper and a windscreen with nothing in between. Two components are joined when several
/// azimuth columns step from one to the other with the next plane up and both together still fit a vehicle.
/// Sources without rings are returned unchanged.
std::vector<Cluster> joinFragments(std::vector<Cluster> components, const PointCloud& cloud, const GroundModel& ground,
                                   const ClusteringParams& params);

/// Sorts out what is too small, too low, overhanging or too large for an obstacle, each with its reason.
Clusters gateClusters(const PointCloud& cloud, const GroundModel& ground, std::vector<Cluster> components,
                      const GateParams& params);

}  // namespace lidar_obstacles
