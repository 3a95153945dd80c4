// SPDX-License-Identifier: BSD-3-Clause
#include "objects/overlap.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace lidar_obstacles {
namespace {

constexpr double kShared = 0.1;  // of the smaller box

double areaOf(const OrientedBox& b) { return b.size.x() * b.size.y(); }

cv::RotatedRect rectangleOf(const OrientedBox& b) {
    constexpr double kDegrees = 57.29577951308232;
    return {cv::Point2f(static_cast<float>(b.center.x()), static_cast<float>(b.center.y())),
            cv::Size2f(static_cast<float>(b.size.x()), static_cast<float>(b.size.y())),
            static_cast<float>(b.yaw * kDegrees)};
}

bool mayTouch(const OrientedBox& a, const OrientedBox& b) {
    const double reach = 0.5 * (a.size.head<2>().norm() + b.size.head<2>().norm());
    return (a.center - b.center).head<2>().squaredNorm() < reach * reach;
}

bool overlap(const OrientedBox& a, const OrientedBox& b) {
    return mayTouch(a, b) && sharedArea(a, b) > kShared * std::min(areaOf(a), areaOf(b));
}

/// May what lies in another's box be a part of it? A thing that is of another class is one of its own.
bool mayBePart(const Obstacle& o, const Obstacle& of) { return o.cls == ObstacleClass::Unknown || o.cls == of.cls; }

/// Gives returns of the one to the other.
void absorb(Obstacle& into, Obstacle& from) {
    into.points.insert(into.points.end(), from.points.begin(), from.points.end());
    into.num_points += from.num_points;
    from.points.clear();
}

/// @return false if there was nothing to take back.
bool takeCompletionBack(Obstacle& o, const GroundModel& ground) {
    const bool completed = o.box.center.head<2>() != o.seen_box.center.head<2>() || o.box.size != o.seen_box.size ||
                           o.box.yaw != o.seen_box.yaw;
    o.box = o.seen_box;
    o.box.center.z() = ground.heightAt(o.box.center.x(), o.box.center.y()) + 0.5 * o.box.size.z();
    return completed;
}

/// Leaves no returns to the one that belongs to the other. @return true if it changed something.
bool separate(Obstacle& p, Obstacle& q, const GroundModel& ground) {
    if (p.points.empty() || q.points.empty() || !overlap(p.box, q.box)) return false;
    const bool p_changed = takeCompletionBack(p, ground), q_changed = takeCompletionBack(q, ground);
    if (!overlap(p.box, q.box)) return p_changed || q_changed;
    Obstacle& smaller = areaOf(p.box) < areaOf(q.box) ? p : q;
    Obstacle& larger = &smaller == &p ? q : p;
    if (!mayBePart(smaller, larger)) return p_changed || q_changed;
    absorb(larger, smaller);
    return true;
}

/// Once through all pairs. @return true if it changed something: a box that was completed may have turned into one
/// that lies elsewhere, where a pair was looked at before.
bool separateAll(std::vector<Obstacle>& obstacles, const GroundModel& ground) {
    bool changed = false;
    for (std::size_t a = 0; a < obstacles.size(); ++a)
        for (std::size_t b = a + 1; b < obstacles.size(); ++b)
            if (separate(obstacles[a], obstacles[b], ground)) changed = true;
    return changed;
}

}  // namespace

double sharedArea(const OrientedBox& a, const OrientedBox& b) {
    std::vector<cv::Point2f> corners;
    cv::rotatedRectangleIntersection(rectangleOf(a), rectangleOf(b), corners);
    if (corners.size() < 3) return 0.0;
    std::vector<cv::Point2f> outline;
    cv::convexHull(corners, outline);
    return cv::contourArea(outline);
}

std::vector<Obstacle> withoutOverlaps(std::vector<Obstacle> obstacles, const GroundModel& ground) {
    while (separateAll(obstacles, ground)) {  // each time fewer are completed, or fewer are left
    }
    obstacles.erase(
        std::remove_if(obstacles.begin(), obstacles.end(), [](const Obstacle& o) { return o.points.empty(); }),
        obstacles.end());
    return obstacles;
}

}  // namespace lidar_obstacles
