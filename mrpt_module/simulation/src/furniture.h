// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What people put beside a road: furniture, building sites, goods.
#pragma once

#include <vector>

#include "clutter_builder.h"

namespace lidar_obstacles::simulation {

/// The solids of such a thing, of the size that `spec` says; details follow from its `variant`. Empty for other kinds.
std::vector<Part> furnitureParts(const ClutterSpec& spec);

/// The same for walls, fences, scaffolds and stairs that stand in one place.
std::vector<Part> barrierParts(const ClutterSpec& spec);

/// Boxes and rods of a thing put together. Frame as the thing's: x along its length, its lower middle at the origin.
class Assembly {
  public:
    explicit Assembly(const ClutterSpec& spec) : l(0.5 * spec.length), w(0.5 * spec.width), h(spec.height) {}

    void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Material m);
    void rod(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius, Material m);
    /// Rods from z `from` to `to` at all four corners, `inset` within them.
    void legs(double from, double to, double inset, double radius);
    Mesh take() { return std::move(mesh_); }

    double l, w, h;  ///< half the length, half the width, the height [m]

  private:
    Mesh mesh_;
};

}  // namespace lidar_obstacles::simulation
