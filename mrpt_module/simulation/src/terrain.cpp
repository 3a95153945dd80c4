// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include "lidar_obstacles/simulation/ground.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kMostVertices = 2e7;  ///< of the lattice: 1 GB of memory

/// Vertices of the terrain on a square lattice.
struct Lattice {
    Eigen::Vector2d origin;
    double cell = 1.0;
    int columns = 0, rows = 0;

    std::size_t index(int c, int r) const { return static_cast<std::size_t>(r) * columns + c; }
    Eigen::Vector2d place(int c, int r) const { return origin + cell * Eigen::Vector2d(c, r); }
};

/// Sums of what the track says about a vertex.
struct Vertex {
    double weight = 0.0;
    double height = 0.0;                                       ///< weighted
    double nearest = std::numeric_limits<double>::infinity();  ///< distance from the track's middle line [m]
};

/// A place of the track and its plane: slope along it, bank across.
struct Sample {
    TrackPoint point;
    Eigen::Vector2d ahead, left;
    double slope = 0.0;
};

std::vector<Sample> samplesOf(const Track& track, double spacing) {
    std::vector<Sample> samples;
    const int n = static_cast<int>(std::ceil(track.length() / spacing));
    for (int i = 0; i <= n; ++i) {
        const double s = track.length() * i / n;
        Sample sample;
        sample.point = track.at(s);
        sample.ahead = {std::cos(sample.point.heading), std::sin(sample.point.heading)};
        sample.left = {-sample.ahead.y(), sample.ahead.x()};
        sample.slope = (track.at(s + 1.0).elevation - track.at(s - 1.0).elevation) / 2.0;
        samples.push_back(sample);
    }
    return samples;
}

Lattice latticeAround(const std::vector<Sample>& samples, const TerrainSpec& terrain) {
    Eigen::AlignedBox2d bounds;
    for (const Sample& s : samples) bounds.extend(s.point.position);
    Lattice lattice;
    lattice.cell = terrain.cell;
    lattice.origin = bounds.min() - Eigen::Vector2d::Constant(terrain.reach);
    const Eigen::Vector2d extent = bounds.sizes() + Eigen::Vector2d::Constant(2.0 * terrain.reach);
    if (extent.prod() > kMostVertices * lattice.cell * lattice.cell)
        throw ScenarioError("terrain.cell: " + std::to_string(lattice.cell) +
                            " m is too fine for a track that covers " + std::to_string(extent.x()) + " x " +
                            std::to_string(extent.y()) + " m");
    lattice.columns = static_cast<int>(std::ceil(extent.x() / lattice.cell)) + 1;
    lattice.rows = static_cast<int>(std::ceil(extent.y() / lattice.cell)) + 1;
    return lattice;
}

class TerrainBuilder {
  public:
    TerrainBuilder(const Track& track, const TerrainSpec& terrain)
        : terrain_(terrain),
          half_width_(0.5 * track.width()),
          samples_(samplesOf(track, std::min(terrain.cell, 2.0))),
          lattice_(latticeAround(samples_, terrain)),
          vertices_(static_cast<std::size_t>(lattice_.columns) * lattice_.rows) {}

    Mesh build() {
        for (const Sample& sample : samples_) scatter(sample);
        Mesh mesh;
        std::vector<std::uint32_t> number(vertices_.size(), 0);
        for (int r = 0; r < lattice_.rows; ++r)
            for (int c = 0; c < lattice_.columns; ++c) {
                const Vertex& v = vertices_[lattice_.index(c, r)];
                if (v.weight <= 0.0) continue;
                const Eigen::Vector2d p = lattice_.place(c, r);
                number[lattice_.index(c, r)] =
                    mesh.addVertex({p.x(), p.y(), v.height / v.weight + bumps(p, v.nearest)});
            }
        for (int r = 0; r + 1 < lattice_.rows; ++r)
            for (int c = 0; c + 1 < lattice_.columns; ++c) addCell(mesh, number, c, r);
        return mesh;
    }

  private:
    /// Tells the vertices within reach what one place of the track says about their height.
    void scatter(const Sample& sample) {
        const double reach = terrain_.reach;
        const Eigen::Vector2d low = (sample.point.position.array() - reach - lattice_.origin.array()) / lattice_.cell;
        const int span = static_cast<int>(std::ceil(2.0 * reach / lattice_.cell)) + 1;
        const int c0 = std::max(0, static_cast<int>(low.x())), r0 = std::max(0, static_cast<int>(low.y()));
        for (int r = r0; r <= std::min(r0 + span, lattice_.rows - 1); ++r)
            for (int c = c0; c <= std::min(c0 + span, lattice_.columns - 1); ++c) {
                const Eigen::Vector2d offset = lattice_.place(c, r) - sample.point.position;
                const double squared = offset.squaredNorm();
                if (squared >= reach * reach) continue;
                // Shepard's weights: what is near decides; faded out towards the end of the reach.
                const double fade = 1.0 - squared / (reach * reach), near = 1.0 / (squared + 1.0);
                const double weight = fade * fade * near * near * near;
                Vertex& v = vertices_[lattice_.index(c, r)];
                v.weight += weight;
                v.height += weight * heightFrom(sample, offset);
                v.nearest = std::min(v.nearest, std::sqrt(squared));
            }
    }

    double heightFrom(const Sample& sample, const Eigen::Vector2d& offset) const {
        const double across = offset.dot(sample.left);
        const double beside = std::max(0.0, std::abs(across) - half_width_);
        return sample.point.elevation + sample.slope * offset.dot(sample.ahead) +
               std::tan(sample.point.bank) * std::clamp(across, -half_width_, half_width_) + terrain_.verge(beside);
    }

    /// Rough ground, rising to its full amplitude within four metres of the pavement.
    double bumps(const Eigen::Vector2d& p, double nearest) const {
        const double share = std::clamp((nearest - half_width_ - 0.5) / 4.0, 0.0, 1.0);
        const double long_waves = std::sin(0.31 * p.x() + 0.17 * p.y() + 1.3) * std::sin(0.27 * p.y() - 0.11 * p.x());
        const double short_waves = std::sin(0.93 * p.x() - 0.41 * p.y()) * std::cos(0.77 * p.y() + 0.37 * p.x());
        return terrain_.roughness * share * (0.65 * long_waves + 0.35 * short_waves);
    }

    void addCell(Mesh& mesh, const std::vector<std::uint32_t>& number, int c, int r) const {
        const std::array<std::size_t, 4> corner{lattice_.index(c, r), lattice_.index(c + 1, r),
                                                lattice_.index(c + 1, r + 1), lattice_.index(c, r + 1)};
        double nearest = 0.0;
        for (std::size_t k : corner) {
            if (vertices_[k].weight <= 0.0) return;
            nearest += 0.25 * vertices_[k].nearest;
        }
        const Material m = nearest <= half_width_ ? Material::Asphalt : terrain_.beside;
        mesh.addTriangle({number[corner[0]], number[corner[1]], number[corner[2]]}, m);
        mesh.addTriangle({number[corner[0]], number[corner[2]], number[corner[3]]}, m);
    }

    TerrainSpec terrain_;
    double half_width_;
    std::vector<Sample> samples_;
    Lattice lattice_;
    std::vector<Vertex> vertices_;
};

}  // namespace

Mesh terrainMesh(const Track& track, const TerrainSpec& terrain) { return TerrainBuilder(track, terrain).build(); }

}  // namespace lidar_obstacles::simulation
