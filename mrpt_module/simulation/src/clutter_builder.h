// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Puts clutter together: places on the track, solids, their boxes.
#pragma once

#include "lidar_obstacles/simulation/clutter.h"

namespace lidar_obstacles::simulation {

/// A solid, its lower middle at the origin of its own frame.
struct Part {
    ObjectKind kind;
    Mesh mesh;
    const char* type = nullptr;  ///< as the table of what stands calls it, where that is not the name of the kind
};

class ClutterBuilder {
  public:
    ClutterBuilder(const Track& track, const Ground& ground) : track_(track), ground_(ground) {}

    /// @param id  of its returns, see SurfaceLabel
    void add(const ClutterSpec& spec, std::int32_t id);
    Clutter take() { return std::move(clutter_); }

  private:
    Eigen::Isometry3d poseAt(const ClutterSpec& spec) const;
    Eigen::Isometry3d poseAlong(const ClutterSpec& spec, double s, double d) const;
    std::vector<Eigen::Isometry3d> posesAlong(const ClutterSpec& spec, double step) const;
    double heightAt(const ClutterSpec& spec, const Eigen::Vector2d& place) const;

    void place(const Eigen::Isometry3d& pose, const Part& part);
    void label(ObjectKind kind);
    void addLine(const ClutterSpec& spec);
    void addHedge(const ClutterSpec& spec);
    void addBoxesAlong(const ClutterSpec& spec, ObjectKind kind, double width);
    void addPosts(const ClutterSpec& spec, double every);

    const Track& track_;
    const Ground& ground_;
    Clutter clutter_;
    std::int32_t id_ = 0;  ///< of what is being added
};

/// The solids of a thing that stands in one place; empty for lines.
std::vector<Part> partsOf(const ClutterSpec& spec);

}  // namespace lidar_obstacles::simulation
