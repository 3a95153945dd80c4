/// @file
/// The pipelines: each a composition of the stages, one line per stage of the paper.
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
};

/// Finds obstacles in one scan with the paper's 16-plane algorithm (Sec. III, Fig. 2).
///
/// @param cloud  N returns, vehicle frame [m], all finite; may be empty (the result is then empty).
/// @param earlier  what is known from earlier scans; without it the result is a function of this scan alone.
/// @return every intermediate and the obstacles, sorted by the distance of their centres, ids from 0.
/// @throws std::invalid_argument if a parameter is out of range or a return is not finite.
DetectionResult detect16Plane(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier = {});

/// Finds obstacles in one scan with the paper's algorithm for 8 planes or fewer (Sec. IV, Fig. 4). Parameters, result
/// and errors as above; the grid has cells of `grid.fine_resolution`.
DetectionResult detect8Plane(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier = {});

/// Both at once: one fine grid, and for each cluster the fit that its returns support: a plane (Sec. III) where at
/// least `auto_min_planes` planes hit it over `auto_min_height`, a hull or line (Sec. IV) where not.
DetectionResult detectAuto(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier = {});

/// The one of the three that `pipeline.algorithm` names.
DetectionResult detect(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier = {});

/// The chain grid -> boxes on any occupancy grid, e.g. another mapper's (Sec. III, Fig. 2).
///
/// @param grid    cells marked Occupied are clustered; vehicle frame.
/// @param cloud   the scan that belongs to it.
/// @param ground  its ground (segmentGround), for heights and the boxes' bottoms.
/// @throws std::invalid_argument if the ground is not that of the cloud, the grid has no resolution, a parameter is out
/// of
///         range or a return is not finite.
DetectionResult detectOnGrid(const OccupancyGrid& grid, const PointCloud& cloud, const GroundModel& ground,
                             const DetectorParams& params);

}  // namespace lidar_obstacles
