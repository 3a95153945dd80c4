// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the 3D filter knows and did, drawn into the scene of a scan.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include "lidar_obstacles/detector.h"

namespace lidar_obstacles {

/// Adds two objects to a scene made by toScene: `filter_voxels`, the voxels by which the filter decides (green cubes,
/// half transparent), and `filtered`, the returns that it took out (red). Either is left out where it would be empty.
void addFilter(mrpt::opengl::COpenGLScene& scene, const SequenceResult& found, const ObstacleDetector& detector);

}  // namespace lidar_obstacles
