// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Triangle meshes and the solids they are put together from. Metres; each solid in the frame its docstring names.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/simulation/material.h"

namespace lidar_obstacles::simulation {

struct Mesh {
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `vertices`
    std::vector<Material> material;                       ///< one per triangle

    bool empty() const { return triangles.empty(); }
    /// Index of the vertex added.
    std::uint32_t addVertex(const Eigen::Vector3d& v);
    void addTriangle(const std::array<std::uint32_t, 3>& corners, Material m);
    /// Two triangles; corners in order around the quad.
    void addQuad(const std::array<Eigen::Vector3d, 4>& corners, Material m);
};

/// Appends `part`, moved by `T_mesh_part`.
void append(Mesh& mesh, const Mesh& part, const Eigen::Isometry3d& T_mesh_part = Eigen::Isometry3d::Identity());

/// Smallest and largest corner; empty for a mesh without vertices.
Eigen::AlignedBox3d boundsOf(const Mesh& mesh);

/// A pose without roll and pitch.
Eigen::Isometry3d uprightPose(const Eigen::Vector3d& position, double yaw);

/// Axis-parallel box between two corners.
Mesh boxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Material m);

/// Closed cylinder or, with two radii, cone from `a` to `b`; a != b.
struct Rod {
    Eigen::Vector3d a, b;
    double radius_a, radius_b;
};
Mesh rodMesh(const Rod& rod, Material m, int segments = 10);

/// Ellipsoid of half axes `axes` about `center`. `roughness` > 0 moves each vertex in and out by up to that share, the
/// same way for the same `variant`: crowns and bushes.
struct Ellipsoid {
    Eigen::Vector3d center, axes;
    double roughness = 0.0;
    std::uint64_t variant = 0;
};
Mesh ellipsoidMesh(const Ellipsoid& ellipsoid, Material m);

/// A cross-section of a lofted body at x: points (y, z) in order around it, the same number in every section.
struct Section {
    double x;
    std::vector<Eigen::Vector2d> points;
    std::vector<Material> edges;  ///< surface from edge k, k + 1 on to the next section; the last edge closes the ring
};
/// The body through consecutive sections; both ends are closed.
Mesh loftMesh(const std::vector<Section>& sections, Material caps);

/// A profile of points (y, z) carried along poses (x forward, y left, z up): walls, rails, kerbs. The profile is open,
/// the ends are closed.
Mesh sweepMesh(const std::vector<Eigen::Isometry3d>& poses, const std::vector<Eigen::Vector2d>& profile, Material m);

}  // namespace lidar_obstacles::simulation
