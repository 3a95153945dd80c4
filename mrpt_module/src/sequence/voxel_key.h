// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Cells of a raster of the world as one number.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scan/floor_to_int.h"

namespace lidar_obstacles {

using VoxelIndex = Eigen::Matrix<std::int64_t, 3, 1>;  ///< of a cell per axis

constexpr int kVoxelBits = 21;  // of a key per axis: at 0.2 m they repeat every 400 km
constexpr std::uint64_t kVoxelMask = (std::uint64_t{1} << kVoxelBits) - 1;

inline std::uint64_t keyOf(const VoxelIndex& cell) {
    std::uint64_t key = 0;
    for (int k = 2; k >= 0; --k) key = (key << kVoxelBits) | (static_cast<std::uint64_t>(cell[k]) & kVoxelMask);
    return key;
}

/// The cell that holds a point.
inline VoxelIndex cellAt(const Eigen::Vector3d& p, double resolution) {
    const Eigen::Vector3d q = p * (1.0 / resolution);
    return {floorToInt(q.x()), floorToInt(q.y()), floorToInt(q.z())};
}

/// Where a search for the key begins in a table of that size, a power of two.
inline std::size_t placeOf(std::uint64_t key, std::size_t size) {
    return ((key * 0x9E3779B97F4A7C15ULL) >> 20U) & (size - 1);
}

}  // namespace lidar_obstacles
