// SPDX-License-Identifier: BSD-3-Clause
#include "phantoms.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

constexpr double kRange = 30.0;  ///< [m]
constexpr double kMargin = 0.3;  ///< [m]
constexpr double kDegrees = 57.295779513082321;

/// The box from above, grown on all sides.
cv::RotatedRect footprintOf(const OrientedBox& box, double margin) {
    return {cv::Point2f(static_cast<float>(box.center.x()), static_cast<float>(box.center.y())),
            cv::Size2f(static_cast<float>(box.size.x() + 2 * margin), static_cast<float>(box.size.y() + 2 * margin)),
            static_cast<float>(box.yaw * kDegrees)};
}

bool isMeant(const Obstacle& o, double fov_deg) {
    const bool road_user =
        o.cls == ObstacleClass::Vehicle || o.cls == ObstacleClass::Pedestrian || o.cls == ObstacleClass::Cyclist;
    const double aside_deg = std::abs(std::atan2(o.box.center.y(), o.box.center.x())) * kDegrees;
    return road_user && (!o.track || o.track->seen) && distanceTo(o.box) <= kRange && aside_deg <= 0.5 * fov_deg;
}

}  // namespace

std::vector<int> phantomsIn(const std::vector<Obstacle>& obstacles, const std::vector<TruthBox>& truth,
                            double fov_deg) {
    std::vector<int> phantoms;
    if (truth.empty()) return phantoms;
    for (const Obstacle& o : obstacles) {
        if (!isMeant(o, fov_deg)) continue;
        const cv::RotatedRect box = footprintOf(o.box, kMargin);
        const bool is_known = std::any_of(truth.begin(), truth.end(), [&](const TruthBox& t) {
            std::vector<cv::Point2f> common;
            return cv::rotatedRectangleIntersection(box, footprintOf(t.box, 0.0), common) != cv::INTERSECT_NONE;
        });
        if (!is_known) phantoms.push_back(o.id);
    }
    return phantoms;
}

}  // namespace lidar_obstacles::apps
