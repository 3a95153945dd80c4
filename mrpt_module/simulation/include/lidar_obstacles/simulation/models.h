// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Road users: what they look like to a lidar and the box that is the truth about them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/object_models.h"
#include "lidar_obstacles/simulation/mesh.h"

namespace lidar_obstacles::simulation {

/// A kind of road user. Frame: x forward, y left, z up, the origin on the ground under the middle of the box.
struct Model {
    std::string name;  ///< as scenarios call it: "sedan"
    ObjectKind kind = ObjectKind::Car;
    Eigen::Vector3d size;        ///< box: length, width, height [m]; wing mirrors stand out of it, as of labelled boxes
    std::vector<Mesh> postures;  ///< one; or the steps of a walk, gone through while the object moves
    double wheelbase = 0.0;      ///< what it stands on the ground with, along x [m]
    double gauge = 0.0;          ///< the same along y [m]
};

/// Names that modelNamed() knows.
std::vector<std::string> modelNames();

/// Builds a model; nullptr if there is none of that name. A `variant` other than 0 differs from the others in size,
/// paint, clothes, load; the same one is always the same.
std::shared_ptr<const Model> modelNamed(const std::string& name, std::uint64_t variant = 0);

/// A bicycle without its rider, upright, size about 1.75 x 0.5 x 1.05 m, in the frame of a model.
Mesh bicycleMesh();

}  // namespace lidar_obstacles::simulation
