// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/classification.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "objects/box.h"

namespace lidar_obstacles {
namespace {

/// What a road user of one class has to be.
struct ClassGate {
    int min_points = 0;
    double max_length = 0.0;  ///< [m]; 0: any
};

ClassGate gateOf(ObstacleClass cls, const GateParams& p) {
    if (cls == ObstacleClass::Vehicle) return {p.min_points_vehicle, p.max_length_vehicle};
    if (cls == ObstacleClass::Pedestrian) return {p.min_points_pedestrian, p.max_length_pedestrian};
    return {p.min_points_cyclist, p.max_length_cyclist};
}

}  // namespace

ObstacleClass topClass(const ClassProbabilities& classes) {
    return static_cast<ObstacleClass>(std::max_element(classes.begin(), classes.end()) - classes.begin());
}

ObstacleClass toldClass(const Obstacle& o, const GateParams& params) {
    if (!isRoadUser(o.cls)) return o.cls;
    const ClassGate gate = gateOf(o.cls, params);
    const bool seen = !o.track || o.track->seen;
    const bool few = seen && o.num_points < gate.min_points;
    const bool long_one = seen && gate.max_length > 0.0 && o.seen_box.size.head<2>().maxCoeff() > gate.max_length;
    const bool doubtful = probabilityOf(o) < static_cast<float>(params.min_probability);
    return few || long_one || doubtful ? ObstacleClass::Unknown : o.cls;
}

void applyClass(Obstacle& o) {
    constexpr double kLongest = 1.0;  // at least, of a bicycle seen from the side [m]
    constexpr double kElongated = 1.5;
    if (o.cls == ObstacleClass::Vehicle || o.cls == ObstacleClass::Unknown) return;
    if (o.box.size.x() < o.box.size.y()) turnQuarters(o, 1);
    const bool along_ride = o.cls == ObstacleClass::Cyclist && o.heading_valid && o.box.size.x() >= kLongest &&
                            o.box.size.x() >= kElongated * o.box.size.y();
    if (along_ride) {  // a rider is no box: what is flat on him lies anywhere between its sides and its diagonal
        o.heading_std = std::hypot(o.heading_std, std::atan2(o.box.size.y(), o.box.size.x()));
        return;
    }
    o.heading_valid = false;
    o.heading_std = 0.0;
    o.rule = HeadingRule::None;
}

}  // namespace lidar_obstacles
