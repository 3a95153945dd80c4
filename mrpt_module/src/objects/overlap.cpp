// SPDX-License-Identifier: BSD-3-Clause
#include "objects/overlap.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "lidar_obstacles/completion.h"
#include "objects/box.h"

namespace lidar_obstacles {
namespace {

constexpr double kShared = 0.1;  // of the smaller box
constexpr double kWithin = 0.7;  // what lies so far within another's box is nothing beside it

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

/// Do they share more than so much of the smaller one?
bool overlap(const OrientedBox& a, const OrientedBox& b, double share = kShared) {
    return mayTouch(a, b) && sharedArea(a, b) > share * std::min(areaOf(a), areaOf(b));
}

/// What is left of a box if one of its faces moves inwards until another box stands clear of it.
struct Cut {
    OrientedBox box;
    double lost = 1.0;  ///< share of its area
};

/// The cut that loses least.
Cut leastCut(const OrientedBox& box, const OrientedBox& other) {
    constexpr int kSteps = 20;
    Cut least;
    for (int k = 0; k < 2; ++k)
        for (const double sense : {-1.0, 1.0})
            for (int step = 1; step < kSteps; ++step) {
                Cut cut{box, static_cast<double>(step) / kSteps};
                if (cut.lost >= least.lost) break;
                cut.box.center.head<2>() -= 0.5 * sense * cut.lost * box.size[k] * axisOf(box, k);
                cut.box.size[k] *= 1.0 - cut.lost;
                if (!overlap(cut.box, other)) least = cut;
            }
    return least;
}

/// Cuts one of two boxes that stand side by side so that they part. @return false if neither can be.
bool cutApart(Obstacle& p, Obstacle& q) {
    if (overlap(p.box, q.box, kWithin)) return false;
    const Cut of_p = leastCut(p.box, q.box), of_q = leastCut(q.box, p.box);
    if (std::min(of_p.lost, of_q.lost) >= 1.0) return false;
    const bool cuts_p = of_p.lost < of_q.lost;
    Obstacle& cut = cuts_p ? p : q;
    const double seen_height = cut.seen_box.size.z();
    cut.box = cuts_p ? of_p.box : of_q.box;
    cut.seen_box = withHeight(cut.box, seen_height);
    return true;
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
    const bool completed = o.box.center.head<2>() != o.seen_box.center.head<2>() ||
                           o.box.size.head<2>() != o.seen_box.size.head<2>() || o.box.yaw != o.seen_box.yaw;
    o.box = withHeight(o.seen_box, o.box.size.z());
    o.box.center.z() = ground.heightAt(o.box.center.x(), o.box.center.y()) + 0.5 * o.box.size.z();
    return completed;
}

/// Two of one class that stand side by side are cut apart; else the one that belongs to the other is left no returns.
/// @return true if it changed something.
bool separate(Obstacle& p, Obstacle& q, const GroundModel& ground) {
    if (p.points.empty() || q.points.empty() || !overlap(p.box, q.box)) return false;
    const bool p_changed = takeCompletionBack(p, ground), q_changed = takeCompletionBack(q, ground);
    if (!overlap(p.box, q.box)) return p_changed || q_changed;
    if (p.cls == q.cls && cutApart(p, q)) return true;
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
    while (separateAll(obstacles, ground)) {  // each time fewer are completed, one is smaller, or fewer are left
    }
    obstacles.erase(
        std::remove_if(obstacles.begin(), obstacles.end(), [](const Obstacle& o) { return o.points.empty(); }),
        obstacles.end());
    return obstacles;
}

}  // namespace lidar_obstacles
