// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/zone_shape.h"

#include <cmath>

namespace lidar_obstacles {

ZonePolygon toPolygon(const Outline& outline) {
    ZonePolygon polygon;
    polygon.outer().reserve(outline.size() + 1);
    for (const Eigen::Vector2d& p : outline) polygon.outer().emplace_back(p.x(), p.y());
    boost::geometry::correct(polygon);
    return polygon;
}

Outline moved(const Outline& outline, const Eigen::Isometry2d& T) {
    Outline result;
    result.reserve(outline.size());
    for (const Eigen::Vector2d& p : outline) result.push_back(T * p);
    return result;
}

Outline cornersOf(const OrientedBox& box) {
    const auto corners = cornersFromAbove(box);
    return Outline(corners.begin(), corners.end());
}

Eigen::Isometry2d seenFromAbove(const Eigen::Isometry3d& T) {
    Eigen::Isometry2d flat = Eigen::Isometry2d::Identity();
    const Eigen::Vector3d ahead = T.linear().col(0);
    flat.linear() = Eigen::Rotation2Dd(std::atan2(ahead.y(), ahead.x())).toRotationMatrix();
    flat.translation() = T.translation().head<2>();
    return flat;
}

std::string faultOf(const Outline& polygon) {
    if (polygon.size() < 3) return "a polygon has at least three corners";
    for (const Eigen::Vector2d& p : polygon)
        if (!p.allFinite()) return "a corner is no finite number";
    const ZonePolygon shape = toPolygon(polygon);
    boost::geometry::validity_failure_type failure{};
    if (!boost::geometry::is_valid(shape, failure)) {
        using namespace boost::geometry;
        if (failure == failure_self_intersections || failure == failure_wrong_orientation)
            return "its sides cross or touch each other";
        if (failure == failure_spikes) return "a side runs back on itself";
        return validity_failure_type_message(failure);
    }
    if (!(boost::geometry::area(shape) > 1e-4)) return "it has no area";
    return "";
}

}  // namespace lidar_obstacles
