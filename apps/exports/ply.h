// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A scan as a PLY file, for CloudCompare, MeshLab, Blender, f3d.
#pragma once

#include <string>

#include "exports/scan_output.h"

namespace lidar_obstacles::apps {

/// The bytes of a PLY file (binary, little endian): vehicle frame [m].
///
/// `vertex`: x y z, red green blue, class (ReturnKind), track (number of the obstacle's track, -1: in none),
/// intensity (0 to 1; 0 where the source tells none), is_box. First all returns, then, with is_box = 1, the corners of
/// the boxes in the order of the obstacles, each with its class and track. `edge`: vertex1 vertex2 and a colour, twelve
/// per box. A scan without returns has no vertex; the file is whole all the same.
std::string plyText(const ScanOutput& scan);

}  // namespace lidar_obstacles::apps
