// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One shot of a laser: from the surfaces on its way to what the sensor tells.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lidar_obstacles/simulation/random.h"
#include "lidar_obstacles/simulation/ray_scene.h"
#include "lidar_obstacles/simulation/scenario.h"
#include "lidar_obstacles/simulation/world.h"

namespace lidar_obstacles::simulation {

constexpr std::uint32_t kNoBody = 0xffffffffU;

/// A body of the ray scene.
struct Body {
    const Mesh* mesh;
    const PoseTrack* poses;  ///< null if it does not move and is not turned
};

struct Echo {
    double range = 0.0;               ///< measured [m]
    double brightness = 0.0;          ///< 0 .. 255, above 100 from reflectors
    std::uint32_t body = kNoBody;     ///< kNoBody: a drop
    std::uint32_t triangle = 0;       ///< of that body
    Eigen::Vector3f normal{0, 0, 0};  ///< in the body's frame, towards the sensor
};

/// Where the light is sent back: at a surface, or inside leaves behind theirs.
struct Stop {
    RayHit hit;
    double depth = 0.0;  ///< behind the surface [m]
};

struct Shot {
    Ray ray;
    double time = 0.0;  ///< since the start of the scenario [s]
};

class BeamCaster {
  public:
    BeamCaster(const RayScene& scene, const std::vector<Body>& bodies, const SensorSpec& sensor)
        : scene_(scene), bodies_(bodies), sensor_(sensor) {}

    /// @param first  receives the body that the middle of the beam meets first, or kNoBody.
    std::optional<Echo> shoot(const Shot& shot, Random& random, std::uint32_t& first) const;

  private:
    Material materialOf(const RayHit& hit) const { return bodies_[hit.body].mesh->material[hit.triangle]; }
    std::optional<Stop> stopOf(const Shot& shot, const RayHit& first, Random& random) const;
    double depthIn(const RayHit& leaves, const Ray& ray, Random& random) const;
    double withMixing(const Ray& ray, const RayHit& hit, const Eigen::Vector3f& normal, Random& random) const;
    Eigen::Vector3f worldNormal(const RayHit& hit, const Shot& shot) const;
    std::optional<Echo> echoOf(const Stop& stop, const Shot& shot, Random& random) const;
    std::optional<Echo> dropEcho(double before, Random& random) const;

    const RayScene& scene_;
    const std::vector<Body>& bodies_;
    const SensorSpec& sensor_;
};

}  // namespace lidar_obstacles::simulation
