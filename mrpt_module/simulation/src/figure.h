// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// People as solids.
#pragma once

#include <vector>

#include "lidar_obstacles/simulation/mesh.h"

namespace lidar_obstacles::simulation {

/// How a person of height 1 is built, holds itself and is dressed. By default it stands upright. Angles in radians.
struct Figure {
    double swing = 0.0;       ///< of the legs to the vertical, one forward, one back; the arms swing against them
    double sit = 0.0;         ///< of both thighs, forwards
    double shin = 0.0;        ///< of both shins, backwards if negative
    double hip_height = 0.0;  ///< of the hips over the soles; 0: as high as the legs carry them
    double lean = 0.0;        ///< of the upper body about the hips, forwards
    double reach = 0.0;       ///< of both arms, forwards
    double bulk = 1.0;        ///< of the trunk
    bool coat = false;        ///< or skirt: covers the thighs
    bool backpack = false;
    Material top = Material::Cloth, bottom = Material::Cloth;
};

/// Soles on z = 0, facing x, the hips above the origin.
Mesh figureMesh(const Figure& figure);

/// The same person dressed and built as `variant` says; as it is for 0.
Figure varied(Figure figure, std::uint64_t variant);

void moveBy(Mesh& mesh, const Eigen::Vector3d& shift);
Mesh scaled(Mesh mesh, double factor);
/// A limb, bar or tube.
void addLimb(Mesh& mesh, const Rod& rod, Material m);
/// Moves the postures so that the box of all of them stands on the origin; its size.
Eigen::Vector3d centre(std::vector<Mesh>& postures);

}  // namespace lidar_obstacles::simulation
