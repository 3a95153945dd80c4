// SPDX-License-Identifier: BSD-3-Clause
#include "common/kitti_labels.h"

#include <cmath>

#include "common/number_text.h"
#include "lidar_obstacles/classification.h"

namespace lidar_obstacles::apps {
namespace {

const char* typeOf(ObstacleClass cls) {
    switch (cls) {
        case ObstacleClass::Vehicle:
            return "Car";
        case ObstacleClass::Pedestrian:
            return "Pedestrian";
        case ObstacleClass::Cyclist:
            return "Cyclist";
        case ObstacleClass::Structure:
        case ObstacleClass::Unknown:
            break;
    }
    return "Misc";
}

/// Type to rotation_y, and the score.
std::string labelOf(const Obstacle& o) {
    const OrientedBox& b = o.box;
    const double right = -b.center.y(), down = -(b.center.z() - b.size.z() / 2), forward = b.center.x();
    const double rotation = normalizeAngle(-b.yaw - M_PI / 2);
    const double alpha = o.heading_valid ? normalizeAngle(rotation - std::atan2(right, forward)) : -10.0;
    std::string label = std::string(typeOf(o.cls)) + " -1 -1 " + fixedText(alpha, 4) + " -1 -1 -1 -1";
    for (const double size : {b.size.z(), b.size.y(), b.size.x()}) label += ' ' + fixedText(size, 3);
    for (const double place : {right, down, forward}) label += ' ' + fixedText(place, 3);
    const double score = probabilityOf(o);
    return label + ' ' + fixedText(rotation, 4) + ' ' + fixedText(score, 4) + '\n';
}

}  // namespace

std::string kittiLines(const std::vector<Obstacle>& obstacles) {
    std::string lines;
    for (const Obstacle& o : obstacles) lines += labelOf(o);
    return lines;
}

std::string kittiTrackingLines(std::size_t scan_index, const std::vector<Obstacle>& obstacles) {
    std::string lines;
    for (const Obstacle& o : obstacles) {
        if (!o.track) continue;
        lines += std::to_string(scan_index) + ' ' + std::to_string(o.id) + ' ' + labelOf(o);
    }
    return lines;
}

}  // namespace lidar_obstacles::apps
