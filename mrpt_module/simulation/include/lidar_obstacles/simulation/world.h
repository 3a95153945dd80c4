// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A scenario put up: everything that rays can hit, and where it is at any time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/simulation/clutter.h"
#include "lidar_obstacles/simulation/models.h"

namespace lidar_obstacles::simulation {

struct WorldObject {
    int id;
    std::shared_ptr<const Model> model;
    std::vector<RayMesh> postures;  ///< as the model's
    Motion motion;

    Stance stance() const { return {model->wheelbase, model->gauge}; }
};

/// What does not move.
struct Structure {
    RayMesh mesh;
    std::vector<SurfaceLabel> labels;  ///< one per triangle
};

/// Frame: the track's. Does not change once built; may be used by several threads.
struct World {
    Scenario scenario;
    std::shared_ptr<const Track> track;
    std::shared_ptr<const Ground> ground;
    std::vector<Structure> structures;  ///< the first is the ground
    std::vector<StaticBox> boxes;       ///< the clutter
    Path ego;
    std::vector<WorldObject> objects;
};

/// @throws ScenarioError if something does not stand on the terrain or the track cannot be right.
World buildWorld(const Scenario& scenario);

/// Poses T_world_thing on an even lattice of times; between two of them every coordinate runs straight.
/// Its const members may be called by several threads at a time.
class PoseTrack {
  public:
    PoseTrack(double start, double step, std::vector<Pose6> nodes);

    Pose6 at(double t) const;
    double start() const { return start_; }
    double end() const { return start_ + step_ * static_cast<double>(nodes_.size() - 1); }
    const std::vector<Pose6>& nodes() const { return nodes_; }

  private:
    double start_, step_;
    std::vector<Pose6> nodes_;
};

struct TimeSpan {
    double from, to;  ///< [s]
};

/// Poses over a span of time and a little more; the lattice is the same whatever the span.
PoseTrack egoPoses(const World& world, const TimeSpan& span);
/// One node only for what does not move during scan `scan`.
PoseTrack objectPoses(const World& world, const WorldObject& object, const TimeSpan& span, std::size_t scan);

/// Which of its postures an object is in at time t.
std::size_t postureAt(const WorldObject& object, double t);

}  // namespace lidar_obstacles::simulation
