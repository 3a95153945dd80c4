// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"
#include "objects/rectangle.h"

namespace lidar_obstacles {

/// A cluster and the scan it is cropped from.
struct CroppedCluster {
    const Cluster& cluster;
    const PointCloud& cloud;
    const GroundModel& ground;
    Eigen::Vector2f viewpoint;            ///< where its sensor is; of several, the one with most of its returns [m]
    std::vector<Eigen::Vector2d> points;  ///< its returns seen from above, relative to the viewpoint [m]

    /// @throws std::invalid_argument for a cluster without returns.
    CroppedCluster(const Cluster& c, const PointCloud& scan, const GroundModel& scan_ground);
};

/// Direction of a box's length (0) or width (1) on the ground, unit length.
Eigen::Vector2d axisOf(const OrientedBox& box, int k);

/// Tells a box, or an obstacle's boxes and faces, by axes that are `quarters` quarter turns counter-clockwise of where
/// they were; what is told stays where it is.
void turnQuarters(OrientedBox& box, int quarters);
void turnQuarters(Obstacle& obstacle, int quarters);

/// How many rings hit these returns' surfaces; 0 where the source has none.
int countRings(const std::vector<std::int32_t>& points, const PointCloud& cloud);

/// The upright box around a cluster's returns with the given orientation: its seen faces lie on the returns, its bottom
/// on the ground, its length along the heading. A box without a heading (HeadingRule::None, or one known too badly) is
/// drawn with length >= width.
Obstacle boxOf(const CroppedCluster& cropped, const Orientation& orientation, const BoxParams& params);

}  // namespace lidar_obstacles
