#include "lidar_obstacles/classification.h"

#include <algorithm>
#include <utility>

namespace lidar_obstacles {

ObstacleClass classify(const Obstacle& o, const ClassParams& p) {
    const double length = std::max(o.box.size.x(), o.box.size.y());
    const double width = std::min(o.box.size.x(), o.box.size.y());
    const double height = o.box.size.z();
    const bool upright = height >= p.person_min_height && height <= p.person_max_height;
    if (length <= p.person_max_size && upright) return ObstacleClass::Pedestrian;
    // the rear of a van is as wide above as below, a rider is not
    const bool rider = upright && height >= p.cyclist_min_height && o.top_share <= p.cyclist_max_top;
    if (length <= p.cyclist_max_length && width <= p.cyclist_max_width && rider) return ObstacleClass::Cyclist;
    if (length >= p.vehicle_min_length && length <= p.vehicle_max_length && width <= p.vehicle_max_width)
        return ObstacleClass::Vehicle;
    return ObstacleClass::Unknown;
}

void applyClass(Obstacle& o) {
    constexpr double kLongest = 1.0;  // at least, of a bicycle seen from the side [m]
    constexpr double kElongated = 1.5;
    constexpr double kQuarterTurn = 1.5707963267948966;
    if (o.cls == ObstacleClass::Vehicle) return;
    if (o.box.size.x() < o.box.size.y()) {
        std::swap(o.box.size.x(), o.box.size.y());
        o.box.yaw = normalizeAngle(o.box.yaw + kQuarterTurn);
    }
    const bool along_ride = o.cls == ObstacleClass::Cyclist && o.heading_valid && o.box.size.x() >= kLongest &&
                            o.box.size.x() >= kElongated * o.box.size.y();
    if (along_ride || o.cls == ObstacleClass::Unknown) return;
    o.heading_valid = false;
    o.heading_std = 0.0;
    o.rule = HeadingRule::None;
}

std::vector<Obstacle> classifyAll(std::vector<Obstacle> obstacles, const ClassParams& params) {
    for (Obstacle& o : obstacles) {
        o.cls = classify(o, params);
        if (o.cls != ObstacleClass::Pedestrian) continue;
        o.heading_valid = false;
        o.heading_std = 0.0;
        o.rule = HeadingRule::None;
    }
    return obstacles;
}

}  // namespace lidar_obstacles
