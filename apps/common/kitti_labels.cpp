#include "common/kitti_labels.h"

#include <cmath>

#include "common/number_text.h"

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

}  // namespace

std::string kittiLines(const std::vector<Obstacle>& obstacles) {
    std::string lines;
    for (const Obstacle& o : obstacles) {
        const OrientedBox& b = o.box;
        const double right = -b.center.y(), down = -(b.center.z() - b.size.z() / 2), forward = b.center.x();
        const double rotation = normalizeAngle(-b.yaw - M_PI / 2);
        const double alpha = o.heading_valid ? normalizeAngle(rotation - std::atan2(right, forward)) : -10.0;
        lines += std::string(typeOf(o.cls)) + " -1 -1 " + fixedText(alpha, 4) + " -1 -1 -1 -1";
        for (const double size : {b.size.z(), b.size.y(), b.size.x()}) lines += ' ' + fixedText(size, 3);
        for (const double place : {right, down, forward}) lines += ' ' + fixedText(place, 3);
        lines += ' ' + fixedText(rotation, 4) + ' ' + std::to_string(o.num_points) + '\n';
    }
    return lines;
}

}  // namespace lidar_obstacles::apps
