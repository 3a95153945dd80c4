#include "face_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "facing_plane.h"
#include "floor_to_int.h"
#include "lidar_obstacles/ground.h"

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;
constexpr double kPi = 3.14159265358979323846;
constexpr float kPiF = 3.14159265f;
constexpr std::size_t kMaxContour = 40;

/// What the sensor sees of the outline: the nearest return of each azimuth step, and its share of the outline.
struct Contour {
    std::vector<Vec2> points;     ///< relative to the sensor, in the order of azimuth
    std::vector<double> weights;  ///< length of outline it stands for [m]
};

/// At most `most` of the points, evenly taken from all.
std::vector<Vec2> everyKth(const std::vector<Vec2>& points, std::size_t most) {
    if (points.size() <= most) return points;
    std::vector<Vec2> fewer;
    fewer.reserve(most);
    for (std::size_t k = 0; k < most; ++k) fewer.push_back(points[k * points.size() / most]);
    return fewer;
}

Contour outline(const std::vector<Vec2>& points) {
    constexpr float kStep = 0.0035f;  // 0.2 deg
    // angles relative to the first return, so that those of a cluster do not wrap
    const auto anglePoint = [](const Vec2& p) {
        return fastAtan2(static_cast<float>(p.y()), static_cast<float>(p.x()));
    };
    const float middle = anglePoint(points[0]);
    std::vector<int> bins(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        float a = anglePoint(points[i]) - middle;
        a = a > kPiF ? a - 2 * kPiF : a < -kPiF ? a + 2 * kPiF : a;
        bins[i] = floorToInt(a / kStep);
    }
    const auto [first, last] = std::minmax_element(bins.begin(), bins.end());
    std::vector<std::int32_t> nearest(*last - *first + 1, -1);
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::int32_t& n = nearest[bins[i] - *first];
        if (n < 0 || points[i].squaredNorm() < points[n].squaredNorm()) n = static_cast<std::int32_t>(i);
    }
    Contour c;
    for (const std::int32_t i : nearest)
        if (i >= 0) c.points.push_back(points[i]);
    c.points = everyKth(c.points, kMaxContour);
    const std::size_t n = c.points.size();
    c.weights.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double before = i > 0 ? (c.points[i] - c.points[i - 1]).norm() : 0.0;
        const double after = i + 1 < n ? (c.points[i + 1] - c.points[i]).norm() : 0.0;
        c.weights[i] = std::clamp(0.5 * (before + after), 0.02, 0.3);
    }
    return c;
}

/// The two edges turned to the sensor (at the origin), infinite where the sensor looks along the axis' inside.
struct SeenEdges {
    double u = 0.0;
    double v = 0.0;
    bool u_seen = false;
    bool v_seen = false;
};

SeenEdges seenEdges(const Contour& c, const Vec2& axis) {
    double u_min = 1e9, u_max = -1e9, v_min = 1e9, v_max = -1e9;
    for (const Vec2& p : c.points) {
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

/// Mean distance of the outline to the nearer of the two seen edges, each return counting by its share of the outline.
double edgeCost(const Contour& c, double angle, double limit) {
    const Vec2 axis(std::cos(angle), std::sin(angle));
    const SeenEdges e = seenEdges(c, axis);
    double sum = 0.0;
    double total = 0.0;
    for (std::size_t i = 0; i < c.points.size(); ++i) {
        const Vec2& p = c.points[i];
        const double du = e.u_seen ? std::abs(axis.x() * p.x() + axis.y() * p.y() - e.u) : limit;
        const double dv = e.v_seen ? std::abs(-axis.y() * p.x() + axis.x() * p.y() - e.v) : limit;
        sum += c.weights[i] * std::min(std::min(du, dv), limit);
        total += c.weights[i];
    }
    return sum / total;
}

/// Coarse to fine search of the angle in [0, 90 deg).
double searchAngle(const Contour& c, double limit) {
    double best = 0.0;
    double best_cost = std::numeric_limits<double>::max();
    const auto attempt = [&](double angle) {
        const double cost = edgeCost(c, angle, limit);
        if (cost < best_cost) {
            best_cost = cost;
            best = angle;
        }
    };
    for (int k = 0; k < 18; ++k) attempt(k * kPi / 36.0);
    for (double step = kPi / 120.0; step > 0.002; step /= 2.5) {
        const double center = best;
        attempt(center - step);
        attempt(center + step);
        if (best == center) continue;
        attempt(best + (best - center));
    }
    return best;
}

/// Least squares over both faces at once: returns near the edge across v and, turned by 90 degrees, those near the
/// edge across u share one direction.
void refine(const Contour& c, const std::vector<Vec2>& points, double distance, Rectangle& r) {
    const Vec2 axis(std::cos(r.angle), std::sin(r.angle));
    const Vec2 normal(-axis.y(), axis.x());
    const SeenEdges e = seenEdges(c, axis);
    std::vector<Vec2> on_face[2];
    for (const Vec2& p : points) {
        const double du = e.u_seen ? std::abs(axis.dot(p) - e.u) : 1e9;
        const double dv = e.v_seen ? std::abs(normal.dot(p) - e.v) : 1e9;
        if (std::min(du, dv) > distance) continue;
        if (dv <= du)
            on_face[0].push_back(Vec2(axis.dot(p), normal.dot(p)));
        else
            on_face[1].push_back(Vec2(normal.dot(p), -axis.dot(p)));
    }
    r.support = 0;
    double sxx = 0.0;
    double sxy = 0.0;
    for (const std::vector<Vec2>& face : on_face) {
        if (face.size() < 2) continue;
        Vec2 mean = Vec2::Zero();
        for (const Vec2& q : face) mean += q / static_cast<double>(face.size());
        for (const Vec2& q : face) {
            sxx += (q.x() - mean.x()) * (q.x() - mean.x());
            sxy += (q.x() - mean.x()) * (q.y() - mean.y());
        }
        r.support += static_cast<int>(face.size());
    }
    constexpr double kNoise = 0.03;
    r.angle_std = sxx > 1e-6 ? kNoise / std::sqrt(sxx) : kPi;
    if (sxx > 1e-6) r.angle += std::clamp(sxy / sxx, -0.1, 0.1);
}

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

void moveBy(const Vec2& offset, Rectangle& r) {
    const Vec2 axis(std::cos(r.angle), std::sin(r.angle));
    const double u = axis.dot(offset);
    const double v = axis.x() * offset.y() - axis.y() * offset.x();
    r.u_min += u;
    r.u_max += u;
    r.v_min += v;
    r.v_max += v;
}

}  // namespace

Rectangle fitRectangle(const Cluster& cluster, const PointCloud& cloud, const PlaneFitParams& params) {
    const Vec2 sensor = cloud.sensor_origin.head<2>().cast<double>();
    std::vector<Vec2> points;
    points.reserve(cluster.points.size());
    for (const std::int32_t i : cluster.points) points.push_back(cloud.xyz[i].head<2>().cast<double>() - sensor);
    const std::vector<Vec2> some = everyKth(points, 300);  // enough to average out the noise of range
    Rectangle r;
    if (params.method == BoxMethod::Plane) {
        const VerticalPlane plane = fitFacingPlane(points, params);
        r.angle = std::atan2(plane.normal.y(), plane.normal.x());
        r.angle_std = plane.normal_std;
        r.support = plane.support;
    } else {
        const Contour contour = outline(points);
        r.angle = searchAngle(contour, params.edge_limit);
        for (int k = 0; k < 2; ++k) refine(contour, some, params.inlier_distance, r);
    }
    setExtents(points, r);
    seatEdges(some, params.inlier_distance, r);
    thicken(r);
    moveBy(sensor, r);
    return r;
}

}  // namespace lidar_obstacles
