#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What a cluster covers seen from above.
struct Footprint {
    Eigen::AlignedBox2f box;            ///< along the vehicle's axes [m]
    std::vector<cv::Point2f> outline;   ///< its outermost returns [m]
    std::vector<std::int32_t> returns;  ///< these returns' indices into the cloud
};

/// Box along the vehicle's axes around some returns of the cloud [m].
Eigen::AlignedBox2f boundsOf(const std::vector<std::int32_t>& points, const PointCloud& cloud);

/// The footprint of some returns of the cloud. `outline` holds, in 16 directions, the outermost returns: enough to tell
/// sizes to a few per cent.
Footprint footprintOf(const std::vector<std::int32_t>& points, const PointCloud& cloud);

/// The footprint of two together.
Footprint merged(const Footprint& a, const Footprint& b);

}  // namespace lidar_obstacles
