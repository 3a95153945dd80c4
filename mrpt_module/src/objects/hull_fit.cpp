// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/hull_fit.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "objects/box.h"
#include "objects/line_fit.h"

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

std::vector<Vec2> relativeCells(const CroppedCluster& cropped) {
    std::vector<Vec2> cells;
    cells.reserve(cropped.cluster.cells.size());
    for (const Eigen::Vector2f& c : cropped.cluster.cells) cells.push_back((c - cropped.viewpoint).cast<double>());
    return cells;
}

struct Hull {
    std::vector<Vec2> corners;  ///< relative to the sensor [m]
    double length = 0.0;        ///< of the smallest rectangle around it [m]
    double width = 0.0;
    double angle = 0.0;  ///< of that rectangle's longer side [rad]
};

Hull convexHull(const std::vector<Vec2>& cells) {
    Hull hull;
    if (cells.empty()) return hull;
    std::vector<cv::Point2f> points;
    points.reserve(cells.size());
    for (const Vec2& c : cells) points.emplace_back(static_cast<float>(c.x()), static_cast<float>(c.y()));
    std::vector<cv::Point2f> corners;
    cv::convexHull(points, corners);
    for (const cv::Point2f& c : corners) hull.corners.emplace_back(c.x, c.y);
    const cv::RotatedRect r = cv::minAreaRect(corners);
    hull.length = std::max(r.size.width, r.size.height);
    hull.width = std::min(r.size.width, r.size.height);
    hull.angle = (r.angle + (r.size.width >= r.size.height ? 0.0 : 90.0)) * M_PI / 180.0;
    return hull;
}

/// The corners of the triangle that two visible sides make.
struct Triangle {
    Vec2 a, b, c;
};

constexpr double kCorner = 0.05;  // how well a corner is known [m]

/// Whether the angle at B is farther from a right one than 15 degrees and what three corners err over the shorter side.
bool isOblique(const Triangle& t) {
    constexpr double kCosine = 0.26;
    const Vec2 a = t.a - t.b, c = t.c - t.b;
    const double shorter = std::min(a.norm(), c.norm());
    return shorter < kCorner || std::abs(a.dot(c)) > (kCosine + 3.0 * kCorner / shorter) * a.norm() * c.norm();
}

/// A and C are the hull's ends to either side as the sensor sees it, B stands out most from the line AC towards the
/// sensor. None if no corner stands out by `corner`, or the sides do not meet at a right angle there: the hull of
/// two things side by side.
std::optional<Triangle> visibleTriangle(const Hull& hull, double corner) {
    Triangle t{hull.corners[0], hull.corners[0], hull.corners[0]};
    for (const Vec2& p : hull.corners) {
        if (cross(t.a, p) < 0.0) t.a = p;  // rightmost: no hull is seen from the inside or under 180 degrees
        if (cross(t.c, p) > 0.0) t.c = p;
    }
    const Vec2 ac = t.c - t.a;
    if (ac.norm() < 1e-6) return std::nullopt;
    const double side = cross(ac, -t.a) < 0.0 ? -1.0 : 1.0;  // of the line AC the sensor lies on
    double highest = 0.0;
    for (const Vec2& p : hull.corners) {
        const double height = side * cross(ac, p - t.a) / ac.norm();
        if (height <= highest) continue;
        highest = height;
        t.b = p;
    }
    if (highest < corner || isOblique(t)) return std::nullopt;
    return t;
}

/// Mean of the directions of both sides modulo 90 degrees, as unit vectors of four times the angle.
///
/// Departs from Sec. IV: a side counts by the square of its length, as the error of its direction falls with it.
double meanDirection(const Triangle& t) {
    Vec2 sum = Vec2::Zero();
    for (const Vec2& side : {Vec2(t.a - t.b), Vec2(t.c - t.b)}) {
        const double four = 4.0 * std::atan2(side.y(), side.x());
        sum += side.squaredNorm() * Vec2(std::cos(four), std::sin(four));
    }
    return std::atan2(sum.y(), sum.x()) / 4.0;
}

Orientation fromTriangle(const Triangle& t, std::size_t cells) {
    Orientation o;
    o.rule = HeadingRule::TwoSides;
    o.angle = meanDirection(t);
    o.angle_std = kCorner / std::max({(t.a - t.b).norm(), (t.c - t.b).norm(), 1e-3});
    o.support = static_cast<int>(cells);
    o.marks = {t.a, t.b, t.c, t.a + t.c - t.b};
    return o;
}

/// Where no line has three points on it, few cells lie far apart: the longer side of the rectangle around them is
/// taken.
Orientation fromLine(const std::vector<Vec2>& points, const Hull& hull, const HullFitParams& params) {
    constexpr int kMinSupport = 3;
    const RansacParams search{params.inlier_distance, params.ransac_iterations, params.seed, 90.0};
    Orientation o = orientationOf(fitFacingPlane(points, search), points, params.inlier_distance, HeadingRule::Line);
    if (o.support >= kMinSupport) return o;
    o.rule = HeadingRule::Line;
    o.angle = hull.angle;
    o.angle_std = std::atan2(hull.width, hull.length);
    o.support = static_cast<int>(points.size());
    return o;
}

/// Turns the orientation to fit the cells near the seen sides best, unless too few lie there.
void refine(const Hull& hull, const std::vector<Vec2>& cells, const HullFitParams& params, Orientation& o) {
    constexpr int kMinSupport = 5;
    Orientation better = o;
    alignWithFaces(hull.corners, cells, params.inlier_distance, better);
    if (better.support >= kMinSupport) o = std::move(better);
}

/// The visible-side decision (Sec. IV, Fig. 4).
Orientation orientationOfHull(const Hull& hull, const std::vector<Vec2>& cells, const CroppedCluster& cropped,
                              const HullFitParams& params) {
    if (hull.corners.empty()) return Orientation{};
    if (hull.length < params.person) {
        Orientation none;
        none.angle = std::atan2(cells[0].y(), cells[0].x());  // drawn across the line of sight
        return none;
    }
    std::optional<Triangle> triangle;
    if (hull.width > params.two_sides) triangle = visibleTriangle(hull, params.corner);
    const std::vector<Vec2>& points = params.line_from == LinePoints::Returns ? cropped.points : cells;
    Orientation o = triangle ? fromTriangle(*triangle, cells.size()) : fromLine(points, hull, params);
    if (params.refine) refine(hull, cells, params, o);
    return o;
}

}  // namespace

Obstacle fitHullBox(const Cluster& cluster, const PointCloud& cloud, const GroundModel& ground,
                    const HullBoxParams& params) {
    const CroppedCluster cropped(cluster, cloud, ground);
    const std::vector<Vec2> cells = relativeCells(cropped);
    const Hull hull = convexHull(cells);
    Obstacle o = boxOf(cropped, orientationOfHull(hull, cells, cropped, params.fit), params.box);
    for (const Vec2& c : hull.corners) o.hull.push_back(c + cropped.viewpoint.cast<double>());
    return o;
}

std::vector<Obstacle> fitHullBoxes(const PointCloud& cloud, const std::vector<Cluster>& clusters,
                                   const GroundModel& ground, const HullBoxParams& params) {
    std::vector<Obstacle> obstacles;
    obstacles.reserve(clusters.size());
    for (const Cluster& c : clusters) obstacles.push_back(fitHullBox(c, cloud, ground, params));
    return obstacles;
}

}  // namespace lidar_obstacles
