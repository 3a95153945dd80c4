// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Ray casting with Embree: meshes, and scenes of meshes that move while the rays are on their way.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "lidar_obstacles/simulation/mesh.h"

namespace lidar_obstacles::simulation {

/// A mesh ready for rays. Copies share it. Rays may be cast by several threads.
class RayMesh {
  public:
    explicit RayMesh(Mesh mesh);

    const Mesh& mesh() const { return data_->mesh; }
    /// Distance along a ray of unit direction to the first triangle, in the mesh's frame; nullopt beyond `limit`.
    std::optional<float> distance(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float limit) const;

  private:
    friend class RayScene;
    struct Data {
        Mesh mesh;
        std::shared_ptr<void> scene;
    };
    std::shared_ptr<const Data> data_;
};

/// A ray in the world: unit direction, and when it is cast as a share 0 .. 1 of the scene's time span.
struct Ray {
    Eigen::Vector3f origin;
    Eigen::Vector3f direction;
    float time = 0.0f;
    float near = 0.0f;
    float far = 0.0f;
};

struct RayHit {
    float distance;
    std::uint32_t body;      ///< number of the body, in the order they were added
    std::uint32_t triangle;  ///< of that body's mesh
    Eigen::Vector3f normal;  ///< of the triangle, unit length, in the body's frame, either side
};

/// Bodies at their poses over a span of time. One thread fills it, then any number may cast.
class RayScene {
  public:
    RayScene();

    /// A body at poses T_world_body evenly spread over the time span, at least one; in between they are interpolated.
    void add(const RayMesh& mesh, const std::vector<Eigen::Isometry3d>& poses);
    /// To be called once, after the last add().
    void commit();

    std::optional<RayHit> cast(const Ray& ray) const;

  private:
    std::shared_ptr<void> scene_;
    std::vector<RayMesh> bodies_;  ///< kept alive
};

}  // namespace lidar_obstacles::simulation
