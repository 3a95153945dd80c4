// SPDX-License-Identifier: BSD-3-Clause
#include "objects/rectangle.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/joined_cloud.h"

namespace lidar_obstacles {

using Vec2 = Eigen::Vector2d;

Eigen::Vector2f viewpointOf(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    if (cloud.sensors.empty()) return cloud.sensor_origin.head<2>();
    return cloud.sensors[sensorThatSaw(points, cloud)].origin.head<2>();
}

std::vector<Vec2> seenFromAbove(const std::vector<std::int32_t>& points, const PointCloud& cloud,
                                const Eigen::Vector2f& viewpoint) {
    const Vec2 sensor = viewpoint.cast<double>();
    std::vector<Vec2> seen;
    seen.reserve(points.size());
    for (const std::int32_t i : points) seen.push_back(cloud.xyz[i].head<2>().cast<double>() - sensor);
    return seen;
}

SeenEdges seenEdges(const std::vector<Vec2>& outline, const Vec2& axis) {
    double u_min = 1e9, u_max = -1e9, v_min = 1e9, v_max = -1e9;
    for (const Vec2& p : outline) {
        const double u = axis.x() * p.x() + axis.y() * p.y();
        const double v = -axis.y() * p.x() + axis.x() * p.y();
        u_min = std::min(u_min, u);
        u_max = std::max(u_max, u);
        v_min = std::min(v_min, v);
        v_max = std::max(v_max, v);
    }
    SeenEdges e;
    e.u_seen = u_min > 0.0 || u_max < 0.0;
    e.v_seen = v_min > 0.0 || v_max < 0.0;
    e.u = u_min > 0.0 ? u_min : u_max;
    e.v = v_min > 0.0 ? v_min : v_max;
    return e;
}

namespace {

/// Sums over points, as the least squares for a line want them.
struct LineSums {
    int n = 0;
    double x = 0.0;
    double y = 0.0;
    double xx = 0.0;
    double xy = 0.0;

    void add(double along, double across) {
        ++n;
        x += along;
        y += across;
        xx += along * along;
        xy += along * across;
    }
};

}  // namespace

void alignWithFaces(const std::vector<Vec2>& outline, const std::vector<Vec2>& points, double distance,
                    Orientation& r) {
    const Vec2 axis(std::cos(r.angle), std::sin(r.angle));
    const Vec2 normal(-axis.y(), axis.x());
    const SeenEdges e = seenEdges(outline, axis);
    LineSums face[2];
    for (const Vec2& p : points) {
        const double u = axis.dot(p);
        const double v = normal.dot(p);
        const double du = e.u_seen ? std::abs(u - e.u) : 1e9;
        const double dv = e.v_seen ? std::abs(v - e.v) : 1e9;
        if (std::min(du, dv) > distance) continue;
        if (dv <= du)
            face[0].add(u, v);
        else
            face[1].add(v, -u);
    }
    r.support = 0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (const LineSums& f : face) {
        if (f.n < 2) continue;
        sxx += f.xx - f.x * f.x / f.n;
        sxy += f.xy - f.x * f.y / f.n;
        r.support += f.n;
    }
    constexpr double kNoise = 0.03;
    r.angle_std = sxx > 1e-6 ? kNoise / std::sqrt(sxx) : M_PI;
    if (sxx > 1e-6) r.angle += std::clamp(sxy / sxx, -0.1, 0.1);
}

namespace {

/// From the sine of the angle between the line of sight and the face: below 6 deg nothing of it is seen, above 24 deg
/// all.
double turned(double min, double max, double range) {
    const double offset = std::max({0.0, min, -max});  // of the face's plane from the sensor
    return std::clamp((offset / range - 0.1) / 0.3, 0.0, 1.0);
}

void setExtents(const std::vector<Vec2>& points, Rectangle& r) {
    const Vec2 axis(std::cos(r.angle), std::sin(r.angle));
    r.u_min = r.v_min = 1e9;
    r.u_max = r.v_max = -1e9;
    for (const Vec2& p : points) {
        const double u = axis.x() * p.x() + axis.y() * p.y();
        const double v = -axis.y() * p.x() + axis.x() * p.y();
        r.u_min = std::min(r.u_min, u);
        r.u_max = std::max(r.u_max, u);
        r.v_min = std::min(r.v_min, v);
        r.v_max = std::max(r.v_max, v);
    }
    const double range = std::max(0.1, r.center().norm());
    r.u_seen = turned(r.u_min, r.u_max, range);
    r.v_seen = turned(r.v_min, r.v_max, range);
}

/// Moves the seen edges inwards from the outermost return to the outermost tenth of those on the face: the noise of
/// many returns pushes the outermost ones out by two to three standard deviations, while a bumper is curved and its
/// middle is what one drives into.
void seatEdges(const std::vector<Vec2>& points, double distance, Rectangle& r) {
    constexpr std::size_t kMinReturns = 8;
    const Vec2 axis(std::cos(r.angle), std::sin(r.angle));
    std::vector<double> inwards;
    inwards.reserve(points.size());
    const auto seat = [&](const Vec2& across, double& min, double& max) {
        if (min <= 0.0 && max >= 0.0) return;
        const bool near_is_min = min > 0.0;
        inwards.clear();
        for (const Vec2& p : points) {
            const double s = near_is_min ? across.dot(p) - min : max - across.dot(p);
            if (s < distance) inwards.push_back(s);
        }
        if (inwards.size() < kMinReturns) return;
        const auto tenth = inwards.begin() + static_cast<std::ptrdiff_t>(inwards.size() / 10);
        std::nth_element(inwards.begin(), tenth, inwards.end());
        (near_is_min ? min : max) += near_is_min ? *tenth : -*tenth;
    };
    seat(axis, r.u_min, r.u_max);
    seat(Vec2(-axis.y(), axis.x()), r.v_min, r.v_max);
}

/// A face seen alone has no depth: gives the rectangle some, away from the sensor.
void thicken(Rectangle& r) {
    constexpr double kThinnest = 0.1;
    const auto grow = [](double& min, double& max) {
        const double missing = kThinnest - (max - min);
        if (missing <= 0.0) return;
        if (min > 0.0)
            max += missing;
        else
            min -= missing;
    };
    grow(r.u_min, r.u_max);
    grow(r.v_min, r.v_max);
}

}  // namespace

Rectangle enclose(const std::vector<Vec2>& points, double angle, double distance) {
    Rectangle r;
    r.angle = angle;
    setExtents(points, r);
    seatEdges(everyKth(points, 300), distance, r);  // enough to average out the noise of range
    thicken(r);
    return r;
}

}  // namespace lidar_obstacles
