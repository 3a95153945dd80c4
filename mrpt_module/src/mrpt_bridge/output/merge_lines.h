/// @file
/// Which pieces the grouping weighed together, drawn into a scene.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Adds the lines `merges_taken` (green) and `merges_refused` (red): from the middle of one part of each merge that was
/// weighed to the middle of the other. Taken are those inside a group. A result without hypotheses adds empty lines.
void addMerges(mrpt::opengl::COpenGLScene& scene, const PointCloud& cloud, const DetectionResult& result);

}  // namespace lidar_obstacles
