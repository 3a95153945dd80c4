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

void takeCompletionBack(Obstacle& o, const GroundModel& ground) {
    o.box = o.seen_box;
    o.box.center.z() = ground.heightAt(o.box.center.x(), o.box.center.y()) + 0.5 * o.box.size.z();
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
    std::vector<bool> gone(obstacles.size(), false);
    for (std::size_t a = 0; a < obstacles.size(); ++a) {
        for (std::size_t b = a + 1; b < obstacles.size() && !gone[a]; ++b) {
            Obstacle& p = obstacles[a];
            Obstacle& q = obstacles[b];
            if (gone[b] || !overlap(p.box, q.box)) continue;
            takeCompletionBack(p, ground);
            takeCompletionBack(q, ground);
            if (!overlap(p.box, q.box)) continue;
            const bool p_smaller = areaOf(p.box) < areaOf(q.box);
            Obstacle& smaller = p_smaller ? p : q;
            if (!mayBePart(smaller, p_smaller ? q : p)) continue;
            absorb(p_smaller ? q : p, smaller);
            gone[p_smaller ? a : b] = true;
        }
    }
    std::vector<Obstacle> kept;
    kept.reserve(obstacles.size());
    for (std::size_t k = 0; k < obstacles.size(); ++k)
        if (!gone[k]) kept.push_back(std::move(obstacles[k]));
    return kept;
}

}  // namespace lidar_obstacles
