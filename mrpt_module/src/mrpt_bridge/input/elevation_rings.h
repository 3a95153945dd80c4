// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Rings of clouds that name none.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace lidar_obstacles {

struct ElevationRings {
    std::vector<std::uint16_t> ring;  ///< of each return, 0 = lowest
    int rings = 0;                    ///< of the sensor, as far as it shows
};

/// Recovers the rings of returns whose elevations fall on steps, as those of a turning lidar do in its own frame.
///
/// Where all steps are those of a known sensor (VLP-16, Puck Hi-Res, HDL-32E, VLP-32C) the rings are that sensor's;
/// otherwise they are counted from the lowest that has returns, and where the steps are even, rings without returns
/// between others count as well.
/// @param points  sensor frame [m].
/// @return nullopt if the elevations fall on no steps: fewer than four, or one return in twenty lies between them.
std::optional<ElevationRings> ringsFromElevations(const std::vector<Eigen::Vector3f>& points);

}  // namespace lidar_obstacles
