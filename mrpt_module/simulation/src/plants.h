// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Vegetation: volumes of leaves on stems, each plant different.
#pragma once

#include <cstdint>

#include "lidar_obstacles/simulation/mesh.h"
#include "lidar_obstacles/simulation/scenario.h"

namespace lidar_obstacles::simulation {

/// A closed volume of leaves. Frame as the plant's.
struct LeafBody {
    Eigen::Vector3d center, half;
    double squareness = 0.0;  ///< 0: an ellipsoid; 1: nearly a box, as hedges are cut
    double taper = 0.0;       ///< how much narrower the top is: 1 ends in a point
    double roughness = 0.0;   ///< standard deviation of the surface, in and out [m]
    std::uint64_t variant = 0;
};
/// Its triangles are turned outwards.
Mesh leafMesh(const LeafBody& body, Material m);

/// Plants as ClutterSpec says: size, `leaves`, `roughness`; the form follows from `variant`. Frame: on the ground under
/// the plant's middle.
/// Trunk and crown: round, of several lobes, slender, or a conifer whose boughs reach down.
struct TreeMeshes {
    Mesh trunk, crown;
};
/// Height of the lower end of a tree's crown [m].
double crownBottom(const ClutterSpec& spec);
TreeMeshes treeMeshes(const ClutterSpec& spec);
/// One to six lobes that reach to the ground.
Mesh bushMesh(const ClutterSpec& spec);
/// Cut into a ball, a cone or a box.
Mesh shrubMesh(const ClutterSpec& spec);
/// Stalks: reeds, tall grass, flowers; a thin volume.
Mesh reedMesh(const ClutterSpec& spec);
/// A piece of a hedge: a box of leaves along x.
Mesh hedgePiece(const ClutterSpec& spec, double length, std::uint64_t piece);

}  // namespace lidar_obstacles::simulation
