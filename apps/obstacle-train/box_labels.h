// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the returns of a recorded scan hit, by the boxes of its truth.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/object_models.h"
#include "lidar_obstacles/point_cloud.h"
#include "lidar_obstacles/simulation/labels.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// A box of a truth file; vehicle frame.
struct LabelledBox {
    OrientedBox box;
    int returns = 0;                 ///< on it, as the truth counts them
    std::int16_t id = 0;             ///< of the object in its recording: 1, 2 ...
    std::optional<ObjectKind> kind;  ///< none: what is in it was left open ("ignore", "dontcare", "misc")
};

/// Where everything that is no structure has a box.
struct LabelledView {
    double half_angle = 0.0;  ///< to the left and right of x [rad]; pi: all around
    double reach = 0.0;       ///< from the origin of the vehicle, seen from above [m]
};

constexpr double kBoxSlack = 0.1;  ///< an object's returns lie in its box, or so near outside of it [m]
constexpr double kBoxDoubt = 0.5;  ///< farther than this from every box a return is no object's [m]

/// A label for each return, by this rule:
/// - in a box, or within kBoxSlack of it: the object's. Of several boxes the smallest counts: a person before a car.
/// - else within kBoxDoubt of a box, in a box that was left open, or out of the labelled view: kUnsure.
/// - else structure (or ground): whatever stands and has no box.
std::vector<simulation::ReturnLabel> labelsByBoxes(const PointCloud& cloud, const std::vector<LabelledBox>& boxes,
                                                   const LabelledView& view);

/// What a type in a truth file means: the kinds of object_models.h and, where these do not have it, the class that the
/// evaluation takes it for ("vehicle", "bicycle").
struct LabelledType {
    bool known = false;
    std::optional<ObjectKind> kind;  ///< as LabelledBox::kind
};
/// @param type  lower case.
LabelledType labelledTypeOf(const std::string& type);

}  // namespace lidar_obstacles::apps
