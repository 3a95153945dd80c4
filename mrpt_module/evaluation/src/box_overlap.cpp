// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/box_overlap.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles::evaluation {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The footprint's corners, counter-clockwise.
Polygon polygonOf(const OrientedBox& box) {
    const auto corners = cornersFromAbove(box);
    return Polygon(corners.begin(), corners.end());
}

/// What of a convex polygon lies to the left of the line from a to b (Sutherland and Hodgman 1974).
Polygon leftOf(const Polygon& subject, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    Polygon kept;
    for (std::size_t j = 0; j < subject.size(); ++j) {
        const Eigen::Vector2d& p = subject[j == 0 ? subject.size() - 1 : j - 1];
        const Eigen::Vector2d& q = subject[j];
        const double dp = cross(b - a, p - a);
        const double dq = cross(b - a, q - a);
        if ((dp >= 0.0) != (dq >= 0.0)) kept.emplace_back(p + dp / (dp - dq) * (q - p));
        if (dq >= 0.0) kept.push_back(q);
    }
    return kept;
}

double areaOf(const Polygon& p) {
    double twice = 0.0;
    for (std::size_t j = 0; j < p.size(); ++j) twice += cross(p[j == 0 ? p.size() - 1 : j - 1], p[j]);
    return 0.5 * twice;
}

double footprint(const OrientedBox& box) { return box.size.x() * box.size.y(); }

}  // namespace

double sharedArea(const OrientedBox& a, const OrientedBox& b) {
    const double apart = (a.center - b.center).head<2>().norm();
    if (!(apart <= 0.5 * (a.size.head<2>().norm() + b.size.head<2>().norm()))) return 0.0;
    if (!std::isfinite(a.yaw) || !std::isfinite(b.yaw)) return 0.0;
    if (std::min(a.size.head<2>().minCoeff(), b.size.head<2>().minCoeff()) <= 0.0) return 0.0;
    Polygon shared = polygonOf(a);
    const Polygon clipper = polygonOf(b);
    for (std::size_t i = 0; i < clipper.size() && !shared.empty(); ++i) {
        shared = leftOf(shared, clipper[i == 0 ? clipper.size() - 1 : i - 1], clipper[i]);
    }
    return shared.size() > 2 ? std::max(0.0, areaOf(shared)) : 0.0;
}

double bevIou(const OrientedBox& a, const OrientedBox& b) {
    const double shared = sharedArea(a, b);
    const double all = footprint(a) + footprint(b) - shared;
    return all > 0.0 ? shared / all : 0.0;
}

double iou3d(const OrientedBox& a, const OrientedBox& b) {
    const double top = std::min(a.center.z() + 0.5 * a.size.z(), b.center.z() + 0.5 * b.size.z());
    const double bottom = std::max(a.center.z() - 0.5 * a.size.z(), b.center.z() - 0.5 * b.size.z());
    const double shared = sharedArea(a, b) * std::max(0.0, top - bottom);
    const double all = a.size.prod() + b.size.prod() - shared;
    return all > 0.0 ? shared / all : 0.0;
}

double nearestFaceDistance(const OrientedBox& box) {
    const double c = std::cos(box.yaw);
    const double s = std::sin(box.yaw);
    const double along = std::abs(c * box.center.x() + s * box.center.y()) - 0.5 * box.size.x();
    const double across = std::abs(-s * box.center.x() + c * box.center.y()) - 0.5 * box.size.y();
    return std::hypot(std::max(0.0, along), std::max(0.0, across));
}

OrientedBox grown(const OrientedBox& box, double margin) {
    OrientedBox larger = box;
    larger.size.head<2>().array() += 2.0 * margin;
    return larger;
}

double wrapAngle(double angle, double period) {
    double a = std::fmod(angle, period);
    if (a <= -0.5 * period) a += period;
    if (a > 0.5 * period) a -= period;
    return a;
}

}  // namespace lidar_obstacles::evaluation
