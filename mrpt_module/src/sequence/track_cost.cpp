// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_cost.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

/// -log of how well the classes agree: 0 where both are sure of the same.
double classCost(const ClassProbabilities& a, const ClassProbabilities& b) {
    constexpr double kConfused = 0.05;  // detectors confuse anything with anything so often
    double agree = 0.0;
    double self = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        agree += a[k] * b[k];
        self += std::max(a[k] * a[k], b[k] * b[k]);
    }
    return -std::log(std::max(kConfused, std::min(1.0, agree / std::max(1e-9, self))));
}

/// People are seen whole or not at all: neither is a scrap of a hedge one, nor do they become one.
bool sizesAgree(const Expectation& track, const PlacedBox& box) {
    constexpr double kTimes = 2.5;
    constexpr double kSlack = 0.4;  // [m]
    if (!isPerson(topClass(track.classes)) && !isPerson(topClass(box.source->classes))) return true;
    const double a = 2.0 * track.box.whole.half.maxCoeff();
    const double b = 2.0 * box.whole.half.maxCoeff();
    return std::max(a, b) <= kTimes * std::min(a, b) + kSlack;
}

}  // namespace

Expectation expect(const Track& track, double at, const Eigen::Vector2d& sensor) {
    Expectation e;
    e.at = at;
    e.motion = track.predicted(at);
    e.classes = track.cls.probabilities();
    e.box.whole = track.flat(e.motion.position(), e.motion.yaw());
    e.box.seen = e.box.whole;
    e.box.sensor = sensor;
    lookAt(e.box);
    return e;
}

FlatBox bodyAt(const Expectation& expected, double time) {
    FlatBox body = expected.box.whole;
    body.center += (time - expected.at) * expected.motion.velocity();
    return body;
}

double costOf(const Track& track, const Expectation& expected, const PlacedBox& box, const TrackingParams& params) {
    constexpr double kFloor = 0.3;      // no place is expected better than that [m]
    constexpr double kGate = 20.0;      // squared distance in units of the errors, over both axes
    constexpr double kShapeCost = 3.0;  // of boxes that do not cover each other at all
    constexpr double kYoung = 1.0;      // of tracks that may be nothing
    const FlatBox body = bodyAt(expected, box.source->time);
    const Eigen::Vector2d position = expected.motion.position() + body.center - expected.box.whole.center;
    const double spread = std::sqrt(expected.motion.covariance().topLeftCorner<2, 2>().trace()) + kFloor;
    const double reach = expected.box.whole.half.norm() + box.whole.half.norm() + std::sqrt(kGate) * (spread + kFloor);
    if ((box.whole.center - position).squaredNorm() > reach * reach || !sizesAgree(expected, box)) return kCostLimit;
    const BoxView view = viewOf(box, position, expected.motion.yaw());
    Measurements z = measure(view, track.shape, box, viewNoise(params, expected.motion));
    z.count = 2;  // the heading is weighed by the overlap
    const double d2 = expected.motion.distance2(z, kFloor);
    if (d2 > kGate) return kCostLimit;
    PlacedBox moved;
    moved.whole = body;
    moved.sensor = box.sensor;  // both as the sensor that saw the box sees them, from where it was then
    lookAt(moved);
    const double cover = std::max(0.5 + 0.5 * generalisedIou(body, box.whole),
                                  polarOverlap(moved, box) * std::exp(-std::abs(moved.range - box.range)));
    const double cost = 0.5 * d2 + kShapeCost * (1.0 - cover) + classCost(expected.classes, box.source->classes) +
                        (track.confirmed() ? 0.0 : kYoung);
    return std::min(kCostLimit, cost);
}

}  // namespace lidar_obstacles
