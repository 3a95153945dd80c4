// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which plane a return was measured by, where the recording does not say.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace lidar_obstacles::apps {

/// Recovers the rings of a turn that is stored ring by ring, the uppermost first, each from straight ahead
/// counter-clockwise through a full circle (KITTI's velodyne files): a plane ends where the azimuth comes past
/// straight ahead again. Gaps of any width are allowed, also the one of a cloud cut to a camera's view.
///
/// Where fewer than `planes` are found, a cloud that reaches around the vehicle lacks the upper ones (sky), one that
/// is cut to the view ahead the lower ones (below the picture).
///
/// @param points  sensor frame [m], in the order of the file.
/// @param planes  of the sensor.
/// @return plane of each point, 0 = lowest; empty for no points.
/// @throws std::runtime_error if more rings are found than the sensor has: the points are in another order.
std::vector<std::uint16_t> recoverRings(const std::vector<Eigen::Vector3f>& points, int planes);

}  // namespace lidar_obstacles::apps
