// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Region of interest and occupancy grid (Mentasti et al., Sec. III.A).
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Returns that may be obstacles: not ground, not higher above it than the limit, inside the region, not on the own
/// vehicle. Indices into the cloud, rising; empty for an empty cloud.
/// @throws std::invalid_argument if `own_body` is not right (own_body.h).
std::vector<std::int32_t> cropToRegion(const PointCloud& cloud, const GroundModel& ground, const RegionParams& params);

/// Returns above the region's height limit: facades, crowns, bridges. Indices into the cloud, rising.
std::vector<std::int32_t> cropAboveRegion(const PointCloud& cloud, const GroundModel& ground,
                                          const RegionParams& params);

/// What the stage needs: the area, and how it is parted into cells.
struct OccupancyGridParams {
    RegionParams region;
    GridParams grid;
};

/// Projects the candidates along the ground's normal and counts them per cell. A cell is occupied when its count
/// reaches the threshold: the given fraction of what one ring would leave on a wall across the cell at that range
/// (many returns near the sensor, one far away). Free cells come from ground returns or from rays; occupied wins.
///
/// @return a grid over the whole region with cells of `grid.resolution`.
OccupancyGrid buildOccupancyGrid(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                 const GroundModel& ground, const OccupancyGridParams& params);

/// The same without free cells.
OccupancyGrid buildOccupiedGrid(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                const GroundModel& ground, const OccupancyGridParams& params);

/// buildOccupancyGrid() with cells of `grid.fine_resolution` (Sec. IV).
OccupancyGrid buildFineGrid(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                            const GroundModel& ground, const OccupancyGridParams& params);

/// Fills `place_of_candidate` of any grid: the cell each candidate falls into when projected along the ground's normal.
OccupancyGrid assignToCells(OccupancyGrid grid, const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                            const GroundModel& ground);

/// Fills `cells` of each cluster: the centres of the grid's cells that its returns fall into, each once.
std::vector<Cluster> addCells(std::vector<Cluster> clusters, const PointCloud& cloud, const GroundModel& ground,
                              const OccupancyGrid& grid);

/// Where a return falls on the ground plane when it is moved along the ground's normal [m].
inline Eigen::Vector2f projectAlongNormal(const Eigen::Vector3f& p, float height, const Eigen::Vector3f& normal) {
    // height is told along z: the way along the normal is height * normal.z
    const float along = height * normal.z();
    return {p.x() - along * normal.x(), p.y() - along * normal.y()};
}

}  // namespace lidar_obstacles
