// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which pieces the grouping weighed together, drawn into a scene.
#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <array>

#include "lidar_obstacles/types.h"

namespace mrpt::opengl {
class CSetOfLines;
}

namespace lidar_obstacles {

constexpr std::array<mrpt::img::TColor, 2> kMergeColors{{{255, 60, 60}, {0, 230, 64}}};  ///< refused, taken

/// Adds a line for each merge that was weighed, from the middle of one part to the middle of the other.
/// @param lines  of refused and of taken merges.
/// @return how many.
std::size_t drawMerges(const PointCloud& cloud, const DetectionResult& result,
                       const std::array<mrpt::opengl::CSetOfLines*, 2>& lines);

/// Adds the lines `merges_taken` (green) and `merges_refused` (red): from the middle of one part of each merge that was
/// weighed to the middle of the other. Taken are those inside a group. A result without hypotheses adds empty lines.
void addMerges(mrpt::opengl::COpenGLScene& scene, const PointCloud& cloud, const DetectionResult& result);

}  // namespace lidar_obstacles
