// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Rows of truth and detections that a test makes by hand.
#pragma once

#include <string>

#include "lidar_obstacles/evaluation/box_overlap.h"
#include "lidar_obstacles/evaluation/evaluate.h"

namespace lidar_obstacles::test {

/// An upright box on the ground z = 0.
inline OrientedBox boxAt(double x, double y, const Eigen::Vector3d& size, double yaw = 0.0) {
    OrientedBox box;
    box.center = {x, y, 0.5 * size.z()};
    box.size = size;
    box.yaw = yaw;
    return box;
}

/// Scan k is at 100 + k / 10 s.
inline double timeOf(int scan) { return 100.0 + 0.1 * scan; }

inline evaluation::TruthObject truthOf(int scan, const std::string& id, const std::string& type, const OrientedBox& box,
                                       int points = 100) {
    evaluation::TruthObject o;
    o.timestamp = timeOf(scan);
    o.scan_index = scan;
    o.object_id = id;
    o.type = type;
    o.group = evaluation::groupOf(type);
    o.box = box;
    o.num_points = points;
    o.range = evaluation::nearestFaceDistance(box);
    return o;
}

inline evaluation::Detection detectionOf(int scan, const std::string& id, const std::string& cls,
                                         const OrientedBox& box, bool heading_valid = true) {
    evaluation::Detection d;
    d.timestamp = timeOf(scan);
    d.scan_index = scan;
    d.id = id;
    d.cls = cls;
    d.group = evaluation::groupOf(cls);
    d.box = box;
    d.heading_valid = heading_valid;
    d.num_points = 100;
    d.range = evaluation::nearestFaceDistance(box);
    return d;
}

const Eigen::Vector3d kVan{5.0, 2.0, 2.0};
const Eigen::Vector3d kPerson{0.5, 0.5, 1.8};

}  // namespace lidar_obstacles::test
