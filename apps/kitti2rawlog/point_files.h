// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scans as bare floats.
#pragma once

#include <filesystem>

#include "sequence.h"

namespace lidar_obstacles::apps {

/// KITTI's velodyne files: x, y, z, reflectance (0 .. 1) as little-endian floats; rings are recovered. Points without
/// range are left out.
/// @throws std::runtime_error naming the file if it cannot be read or is cut within a point.
void readKittiPoints(const std::filesystem::path& file, int planes, Frame& frame);

/// nuScenes' .pcd.bin files: x, y, z, intensity (0 .. 255), ring. Rings that count from the top are turned around.
/// @throws as above; also for a ring outside 0 .. planes - 1.
void readNuScenesPoints(const std::filesystem::path& file, int planes, Frame& frame);

}  // namespace lidar_obstacles::apps
