// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The pipeline: a composition of the stages, one line per stage of the paper.
#pragma once

#include <functional>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// The candidates that stay, rising, of those it is given.
using CandidateFilter = std::function<std::vector<std::int32_t>(const PointCloud&, const std::vector<std::int32_t>&)>;

/// What a caller that remembers earlier scans (detector.h) adds to one. Empty: nothing; the scan stands for itself.
struct EarlierScans {
    CandidateFilter filter;  ///< the 3D filter before the grid; not set: all stay
    /// Candidates of earlier scans in the vehicle frame of this one [m]; they fill the grid, and are in no cluster.
    std::vector<Eigen::Vector3f> returns;
    /// Objects that are followed. A group on the very returns that are in such a box is rather whole than not, and
    /// rather of that class; where there are no returns, nothing is found.
    std::vector<ExpectedObject> objects;
};

/// Finds obstacles in one scan (Sec. III, IV). `pipeline.algorithm` chooses the cells and the fit, all else is the
/// same:
///
/// * `16-plane` (Sec. III, Fig. 2): cells of `grid.resolution`; vertical planes through each cluster's returns.
/// * `8-plane` (Sec. IV, Fig. 4): cells of `grid.fine_resolution`; the convex hull of each cluster's cells.
/// * `auto`: fine cells; a plane where at least `auto_min_planes` rings hit a cluster over at least `auto_min_height`,
/// a
///   hull where not.
///
/// `pipeline.bare_paper` leaves out everything that the paper does not have (barePaper).
///
/// @param cloud  N returns, vehicle frame [m], all finite; may be empty (the result is then empty).
/// @param earlier  what is known from earlier scans; without it the result is a function of this scan alone.
/// @return every intermediate and the obstacles, sorted by the distance of their centres, ids from 0. What stands and
/// is no road user is among them, as class Structure.
/// @throws std::invalid_argument if a parameter is out of range or a return is not finite.
DetectionResult detect(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier = {});

/// The chain grid -> boxes on any occupancy grid, e.g. another mapper's (Sec. III, Fig. 2), by the same choice of fit.
///
/// @param grid    cells marked Occupied are clustered; vehicle frame.
/// @param cloud   the scan that belongs to it.
/// @param ground  its ground (segmentGround), for heights and the boxes' bottoms.
/// @throws std::invalid_argument if the ground is not that of the cloud, the grid has no resolution, its occupied cells
/// are not in rising order or not all inside, a parameter is out of range or a return is not finite.
DetectionResult detectOnGrid(const OccupancyGrid& grid, const PointCloud& cloud, const GroundModel& ground,
                             const DetectorParams& params);

}  // namespace lidar_obstacles
