// SPDX-License-Identifier: BSD-3-Clause
#include "objects/line_fit.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;

/// Is a point within a distance of the plane? One just as far away is: cells stand in rows, and whether they are that
/// far off must not be for the last digit to say.
bool isNear(const VerticalPlane& plane, const Vec2& p, double distance) {
    constexpr double kRounding = 1e-9;  // [m]
    return std::abs(plane.normal.dot(p) - plane.offset) < distance + kRounding;
}

int countInliers(const std::vector<Vec2>& points, const VerticalPlane& plane, double distance) {
    int n = 0;
    for (const Vec2& p : points) n += isNear(plane, p, distance);
    return n;
}

/// Total least squares on the returns within the distance of the plane.
VerticalPlane refit(const std::vector<Vec2>& points, const VerticalPlane& plane, double distance) {
    Vec2 mean = Vec2::Zero();
    Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
    int n = 0;
    for (const Vec2& p : points) {
        if (!isNear(plane, p, distance)) continue;
        mean += p;
        moment += p * p.transpose();
        ++n;
    }
    if (n < 3) return plane;
    mean /= n;
    const Eigen::Matrix2d cov = moment / n - mean * mean.transpose();
    const double along = 0.5 * std::atan2(2.0 * cov(0, 1), cov(0, 0) - cov(1, 1));
    VerticalPlane better;
    better.normal = Vec2(-std::sin(along), std::cos(along));
    if (better.normal.dot(plane.normal) < 0.0) better.normal = -better.normal;
    better.offset = better.normal.dot(mean);
    better.support = n;
    constexpr double kNoise = 0.03;  // of a return's range [m]
    const double spread = 0.5 * (cov.trace() + std::hypot(cov(0, 0) - cov(1, 1), 2.0 * cov(0, 1)));  // along the plane
    better.normal_std = spread > 1e-9 ? kNoise / std::sqrt(spread * n) : M_PI;
    return better;
}

}  // namespace

VerticalPlane fitFacingPlane(const std::vector<Vec2>& points, const RansacParams& params) {
    constexpr double kMinBaseline = 0.1;  // nearer pairs say nothing about a direction [m]
    std::mt19937 random(static_cast<std::uint32_t>(params.seed));
    const double min_cos = std::cos(params.max_facing_deg * M_PI / 180.0);
    VerticalPlane best;
    for (int k = 0; k < params.iterations && !points.empty(); ++k) {
        const Vec2& a = points[random() % points.size()];
        const Vec2& b = points[random() % points.size()];
        if ((b - a).norm() < kMinBaseline) continue;
        VerticalPlane plane;
        plane.normal = Vec2(a.y() - b.y(), b.x() - a.x()).normalized();
        const Vec2 to_sensor = -(a + b).normalized();
        if (plane.normal.dot(to_sensor) < 0.0) plane.normal = -plane.normal;
        if (plane.normal.dot(to_sensor) < min_cos) continue;
        plane.offset = plane.normal.dot(a);
        plane.support = countInliers(points, plane, params.inlier_distance);
        if (plane.support > best.support) best = plane;
    }
    for (int k = 0; k < 3 && best.support > 0; ++k) best = refit(points, best, params.inlier_distance);
    return best;
}

Orientation orientationOf(const VerticalPlane& plane, const std::vector<Vec2>& points, double distance,
                          HeadingRule rule) {
    Orientation o;
    o.rule = plane.support > 0 ? rule : HeadingRule::None;
    o.angle = std::atan2(plane.normal.y(), plane.normal.x());
    o.angle_std = plane.normal_std;
    o.support = plane.support;
    const Vec2 along(-plane.normal.y(), plane.normal.x());
    double first = 1e9;
    double last = -1e9;
    for (const Vec2& p : points) {
        if (!isNear(plane, p, distance)) continue;
        first = std::min(first, along.dot(p));
        last = std::max(last, along.dot(p));
    }
    if (first <= last)
        o.marks = {plane.offset * plane.normal + first * along, plane.offset * plane.normal + last * along};
    return o;
}

}  // namespace lidar_obstacles
