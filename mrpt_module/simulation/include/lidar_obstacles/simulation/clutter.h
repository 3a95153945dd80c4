// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What stands beside the track.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/object_models.h"
#include "lidar_obstacles/simulation/ground.h"

namespace lidar_obstacles::simulation {

/// The truth about a standing thing. World frame.
struct StaticBox {
    std::string type;  ///< "tree", "pole" ...; "overhead" for what one drives under
    Eigen::Vector3d center, size;
    double yaw;
};

/// What a triangle of something that stands belongs to.
struct SurfaceLabel {
    std::int32_t id = 0;  ///< -1, -2 ...: place in Scenario::clutter, counted from one; 0: the terrain
    ObjectKind kind = ObjectKind::Ground;
};

struct Clutter {
    Mesh mesh;
    std::vector<SurfaceLabel> labels;  ///< one per triangle
    std::vector<StaticBox> boxes;
};

/// True for what vehicles stand on: sidewalks, kerbs, ramps.
bool isDrivable(ClutterKind kind);

/// Builds the clutter that is drivable, or the one that is not, on the ground that there is before it.
/// @throws ScenarioError if something stands beside the ground.
Clutter buildClutter(const std::vector<ClutterSpec>& specs, bool drivable, const Track& track, const Ground& ground);

}  // namespace lidar_obstacles::simulation
