// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/mesh.h"

#include <cmath>

#include "lidar_obstacles/simulation/random.h"

namespace lidar_obstacles::simulation {
namespace {

using Index = std::uint32_t;

/// Two triangles between vertices i, i + 1 of one row and of the next.
void addStrip(Mesh& mesh, const std::array<Index, 4>& corners, Material m) {
    mesh.addTriangle({corners[0], corners[1], corners[2]}, m);
    mesh.addTriangle({corners[0], corners[2], corners[3]}, m);
}

/// Closes a ring of n vertices from `first` on with triangles about their mean.
void addFan(Mesh& mesh, Index first, Index n, Material m) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (Index k = 0; k < n; ++k) mean += mesh.vertices[first + k].cast<double>() / n;
    const Index center = mesh.addVertex(mean);
    for (Index k = 0; k < n; ++k) mesh.addTriangle({center, first + k, first + (k + 1) % n}, m);
}

}  // namespace

Index Mesh::addVertex(const Eigen::Vector3d& v) {
    vertices.push_back(v.cast<float>());
    return static_cast<Index>(vertices.size() - 1);
}

void Mesh::addTriangle(const std::array<Index, 3>& corners, Material m) {
    triangles.push_back(corners);
    material.push_back(m);
}

void Mesh::addQuad(const std::array<Eigen::Vector3d, 4>& corners, Material m) {
    std::array<Index, 4> index{};
    for (std::size_t k = 0; k < 4; ++k) index[k] = addVertex(corners[k]);
    addStrip(*this, index, m);
}

void append(Mesh& mesh, const Mesh& part, const Eigen::Isometry3d& T_mesh_part) {
    const auto offset = static_cast<Index>(mesh.vertices.size());
    for (const Eigen::Vector3f& v : part.vertices) mesh.addVertex(T_mesh_part * v.cast<double>());
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
        const auto& [a, b, c] = part.triangles[t];
        mesh.addTriangle({a + offset, b + offset, c + offset}, part.material[t]);
    }
}

Eigen::AlignedBox3d boundsOf(const Mesh& mesh) {
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3f& v : mesh.vertices) bounds.extend(v.cast<double>());
    return bounds;
}

Eigen::Isometry3d uprightPose(const Eigen::Vector3d& position, double yaw) {
    return Eigen::Translation3d(position) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
}

Mesh boxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Material m) {
    const auto ring = [&](double x) {
        return Section{x,
                       {{low.y(), low.z()}, {high.y(), low.z()}, {high.y(), high.z()}, {low.y(), high.z()}},
                       std::vector<Material>(4, m)};
    };
    return loftMesh({ring(low.x()), ring(high.x())}, m);
}

Mesh rodMesh(const Rod& rod, Material m, int segments) {
    const Eigen::Vector3d axis = (rod.b - rod.a).normalized();
    const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
    const auto n = static_cast<Index>(segments);
    Mesh mesh;
    for (const auto& [center, radius] : {std::pair{rod.a, rod.radius_a}, std::pair{rod.b, rod.radius_b}}) {
        for (Index k = 0; k < n; ++k) {
            const double angle = 2.0 * M_PI * k / n;
            mesh.addVertex(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
        }
    }
    for (Index k = 0; k < n; ++k) addStrip(mesh, {k, (k + 1) % n, n + (k + 1) % n, n + k}, m);
    addFan(mesh, 0, n, m);
    addFan(mesh, n, n, m);
    return mesh;
}

Mesh ellipsoidMesh(const Ellipsoid& e, Material m) {
    constexpr Index kColumns = 14, kRows = 8;
    Mesh mesh;
    for (Index r = 0; r <= kRows; ++r) {
        const double polar = M_PI * r / kRows;
        for (Index c = 0; c < kColumns; ++c) {
            const double azimuth = 2.0 * M_PI * c / kColumns;
            const Eigen::Vector3d unit(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                       std::cos(polar));
            // A pole is one place: all of its vertices move alike.
            const bool pole = r == 0 || r == kRows;
            const double bump = e.roughness * Random(e.variant, r, pole ? 0 : c).uniform(-1.0, 0.0);
            mesh.addVertex(e.center + (1.0 + bump) * e.axes.cwiseProduct(unit));
        }
    }
    for (Index r = 0; r < kRows; ++r)
        for (Index c = 0; c < kColumns; ++c) {
            const Index next = (c + 1) % kColumns;
            addStrip(mesh, {r * kColumns + c, r * kColumns + next, (r + 1) * kColumns + next, (r + 1) * kColumns + c},
                     m);
        }
    return mesh;
}

Mesh loftMesh(const std::vector<Section>& sections, Material caps) {
    Mesh mesh;
    const auto n = static_cast<Index>(sections.front().points.size());
    for (const Section& s : sections)
        for (const Eigen::Vector2d& p : s.points) mesh.addVertex({s.x, p.x(), p.y()});
    for (Index s = 0; s + 1 < sections.size(); ++s)
        for (Index k = 0; k < n; ++k) {
            const Index a = s * n, b = a + n, next = (k + 1) % n;
            addStrip(mesh, {a + k, a + next, b + next, b + k}, sections[s].edges[k]);
        }
    addFan(mesh, 0, n, caps);
    addFan(mesh, static_cast<Index>(sections.size() - 1) * n, n, caps);
    return mesh;
}

Mesh sweepMesh(const std::vector<Eigen::Isometry3d>& poses, const std::vector<Eigen::Vector2d>& profile, Material m) {
    Mesh mesh;
    const auto n = static_cast<Index>(profile.size());
    for (const Eigen::Isometry3d& pose : poses)
        for (const Eigen::Vector2d& p : profile) mesh.addVertex(pose * Eigen::Vector3d(0.0, p.x(), p.y()));
    for (Index s = 0; s + 1 < poses.size(); ++s)
        for (Index k = 0; k + 1 < n; ++k)
            addStrip(mesh, {s * n + k, s * n + k + 1, (s + 1) * n + k + 1, (s + 1) * n + k}, m);
    addFan(mesh, 0, n, m);
    addFan(mesh, static_cast<Index>(poses.size() - 1) * n, n, m);
    return mesh;
}

}  // namespace lidar_obstacles::simulation
