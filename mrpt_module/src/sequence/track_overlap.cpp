// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_overlap.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A convex polygon of at most eight corners, counter-clockwise.
struct Polygon {
    std::array<Vec2, 9> at;
    std::size_t size = 0;

    void add(const Vec2& p) {
        if (size < at.size()) at[size++] = p;
    }
    double area() const {
        double twice = 0.0;
        for (std::size_t k = 0; k < size; ++k) twice += cross(at[k], at[(k + 1) % size]);
        return std::max(0.0, 0.5 * twice);
    }
};

/// The part of a polygon on the left of the line from a to b.
Polygon leftOf(const Polygon& p, const Vec2& a, const Vec2& b) {
    Polygon out;
    for (std::size_t k = 0; k < p.size; ++k) {
        const Vec2& from = p.at[k];
        const Vec2& to = p.at[(k + 1) % p.size];
        const double f = cross(b - a, from - a);
        const double t = cross(b - a, to - a);
        if (f >= 0.0) out.add(from);
        if ((f > 0.0 && t < 0.0) || (f < 0.0 && t > 0.0)) out.add(from + f / (f - t) * (to - from));
    }
    return out;
}

/// Area of the convex hull of the corners of two boxes (monotone chain).
double hullArea(const FlatBox& a, const FlatBox& b) {
    std::array<Vec2, 8> p;
    const auto ca = a.corners();
    const auto cb = b.corners();
    std::copy(ca.begin(), ca.end(), p.begin());
    std::copy(cb.begin(), cb.end(), p.begin() + 4);
    std::sort(p.begin(), p.end(),
              [](const Vec2& l, const Vec2& r) { return l.x() < r.x() || (l.x() == r.x() && l.y() < r.y()); });
    std::array<Vec2, 17> hull;
    std::size_t n = 0;
    for (int half = 0; half < 2; ++half) {
        const std::size_t start = n;
        for (const Vec2& q : p) {
            while (n >= start + 2 && cross(hull[n - 1] - hull[n - 2], q - hull[n - 2]) <= 0.0) --n;
            hull[n++] = q;
        }
        --n;  // the last is the first of the other half
        std::reverse(p.begin(), p.end());
    }
    double twice = 0.0;
    for (std::size_t k = 0; k < n; ++k) twice += cross(hull[k], hull[(k + 1) % n]);
    return 0.5 * std::abs(twice);
}

}  // namespace

double sharedArea(const FlatBox& a, const FlatBox& b) {
    Polygon p;
    for (const Vec2& corner : a.corners()) p.add(corner);
    const auto clip = b.corners();
    for (std::size_t k = 0; k < clip.size() && p.size > 0; ++k) p = leftOf(p, clip[k], clip[(k + 1) % clip.size()]);
    return p.area();
}

bool mostlyWithin(const FlatBox& box, const FlatBox& body) {
    constexpr double kWithin = 0.7;
    if ((box.center - body.center).norm() > body.half.norm()) return false;
    return sharedArea(body, box) > kWithin * box.area();
}

bool standApart(FlatBox a, const FlatBox& b) {
    constexpr double kApart = 0.5;  // [m]
    a.half.array() += kApart;
    return (a.center - b.center).norm() > a.half.norm() + b.half.norm() || sharedArea(a, b) <= 0.0;
}

double generalisedIou(const FlatBox& a, const FlatBox& b) {
    const double shared = sharedArea(a, b);
    const double both = a.area() + b.area() - shared;
    const double hull = std::max(both, hullArea(a, b));
    return shared / both - (hull - both) / hull;
}

double polarOverlap(const PlacedBox& a, const PlacedBox& b) {
    const double apart = std::abs(normalizeAngle(a.bearing - b.bearing));
    const double shared = std::min({2.0 * a.half_angle, 2.0 * b.half_angle, a.half_angle + b.half_angle - apart});
    if (shared <= 0.0) return 0.0;
    return shared / (2.0 * (a.half_angle + b.half_angle) - shared);
}

}  // namespace lidar_obstacles
