// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The order in which a source counts its rings.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace lidar_obstacles {

/// The number of each ring when they are counted upwards from the lowest: makers count from the top (Ouster, Hesai) or
/// in the order in which the lasers fire (MRPT's generatePointCloud()). Rings without returns are taken for the sky's.
/// Few of the points are looked at.
/// @param points  in the sensor's frame [m], none at its origin.
/// @param ring    of each, below `rings`.
/// @return empty where they count upwards already, and where the points do not tell: rings that hold returns of many
///         elevations, as those of clouds that are not in the sensor's frame.
std::vector<int> ringsUpwards(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint16_t>& ring,
                              int rings);

}  // namespace lidar_obstacles
