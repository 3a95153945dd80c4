// SPDX-License-Identifier: BSD-3-Clause
#include "asked.h"

#include <cmath>

namespace lidar_obstacles::evaluation {

bool isInRegion(const OrientedBox& box, const EvaluationOptions& options) {
    constexpr double kDegrees = 180.0 / M_PI;
    const Eigen::Vector3d& c = box.center;
    if (options.fov_deg < 360.0 && std::abs(std::atan2(c.y(), c.x())) * kDegrees > 0.5 * options.fov_deg) return false;
    if (!options.roi) return true;
    const RegionOfInterest& r = *options.roi;
    return r.x_min <= c.x() && c.x() <= r.x_max && r.y_min <= c.y() && c.y() <= r.y_max;
}

bool isAskedFor(const TruthObject& o, const EvaluationOptions& options) {
    return o.num_points >= options.min_points && o.range <= options.max_range && isInRegion(o.box, options);
}

bool isClaim(const Detection& d, const EvaluationOptions& options) {
    return options.structure || d.cls != lidar_obstacles::toString(ObstacleClass::Structure);
}

}  // namespace lidar_obstacles::evaluation
