// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What vehicles stand on: the terrain along a track, and what of the clutter can be driven on.
#pragma once

#include <optional>

#include "lidar_obstacles/simulation/motion.h"
#include "lidar_obstacles/simulation/ray_scene.h"
#include "lidar_obstacles/simulation/track.h"

namespace lidar_obstacles::simulation {

/// The land within `terrain.reach` of the track: the pavement with its slope and bank, beside it the verge and rough
/// ground. Where parts of the track lie near each other their heights blend.
/// @throws ScenarioError if the cells are too small for the size of the track.
Mesh terrainMesh(const Track& track, const TerrainSpec& terrain);

/// Heights of a mesh seen from above.
/// Its const members may be called by several threads at a time.
class Ground {
  public:
    explicit Ground(Mesh mesh);

    const RayMesh& mesh() const { return mesh_; }
    /// z of the highest surface at a place; nullopt where there is none.
    std::optional<double> heightAt(const Eigen::Vector2d& place) const;

  private:
    RayMesh mesh_;
    double top_ = 0.0;  ///< above all of it
};

/// What a thing stands on the ground with: wheels at the corners of a rectangle, or one point where both are 0.
struct Stance {
    double wheelbase = 0.0;
    double gauge = 0.0;
};

/// Height, pitch and roll of what stands there.
/// @throws ScenarioError if it stands beside the ground.
Pose6 standOn(const Ground& ground, const PlanarPose& pose, const Stance& stance);

Eigen::Isometry3d toIsometry(const Pose6& pose);

}  // namespace lidar_obstacles::simulation
