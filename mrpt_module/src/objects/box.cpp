// SPDX-License-Identifier: BSD-3-Clause
#include "objects/box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;
constexpr double kMaxHeadingStd = 0.35;  // 20 deg: a direction known worse than that is none

void setHeights(const CroppedCluster& c, Obstacle& o) {
    const double top = std::max(0.1f, c.cluster.top);
    o.box.size.z() = top;
    o.box.center.z() = c.ground.heightAt(o.box.center.x(), o.box.center.y()) + 0.5 * top;
    o.max_height = std::max<double>(top, c.cluster.max_top);
}

/// How badly the extent of a face fits a vehicle's length (or width): what is too much, and what is missing as far as
/// the face is turned to the sensor (`seen`, 0 .. 1) [m].
double misfit(double extent, double shortest, double longest, double seen) {
    return std::max(0.0, extent - longest) + seen * std::max(0.0, shortest - extent);
}

/// Which of the rectangle's axes is the vehicle's length? A face as wide as a rear is a rear, however little of the
/// side is seen: the heading is then its normal (Sec. III.A), not the longer side of the box.
bool lengthIsAlongU(const Rectangle& r, double height, const BoxParams& params) {
    const double widest = height > params.tall ? params.max_rear_width : params.max_car_width;
    const auto cost = [&](double length, double length_seen, double width, double width_seen) {
        return misfit(length, params.min_vehicle_length, 100.0, length_seen) +
               misfit(width, params.min_rear_width, widest, width_seen) + 2.0 * std::max(0.0, width - widest);
    };
    // the face across v (at its edge in v) shows the extent along u, and the other way round
    return cost(r.size_u(), r.v_seen, r.size_v(), r.u_seen) < cost(r.size_v(), r.u_seen, r.size_u(), r.v_seen);
}

/// The faces turned to the sensor that returns lie on, not counting those at a corner that belong to the other face.
std::uint8_t facesWithReturns(const std::vector<Vec2>& points, const Obstacle& o, const Vec2& center, double distance) {
    constexpr double kCorner = 0.2;
    constexpr int kMinReturns = 3;
    const Vec2 forward(std::cos(o.box.yaw), std::sin(o.box.yaw));
    const Vec2 left(-forward.y(), forward.x());
    std::uint8_t faces = 0;
    const auto look = [&](std::uint8_t face, const Vec2& outwards, double half, double half_across) {
        if (-outwards.dot(center) <= half) return;  // turned away
        const Vec2 along(-outwards.y(), outwards.x());
        int returns = 0;
        for (const Vec2& p : points) {
            const Vec2 d = p - center;
            returns += outwards.dot(d) > half - distance && std::abs(along.dot(d)) < half_across - kCorner;
        }
        if (returns >= kMinReturns) faces |= face;
    };
    const double half_length = 0.5 * o.box.size.x();
    const double half_width = 0.5 * o.box.size.y();
    look(kFront, forward, half_length, half_width);
    look(kBack, -forward, half_length, half_width);
    look(kLeft, left, half_width, half_length);
    look(kRight, -left, half_width, half_length);
    return faces;
}

/// Position, size across the ground and yaw from a rectangle; the half turn is not seen: told in the direction of
/// travel.
void setFootprint(const Rectangle& r, bool along_u, OrientedBox& box) {
    Vec2 forward = along_u ? r.u_axis() : r.v_axis();
    if (forward.x() < 0.0) forward = -forward;
    box.yaw = normalizeAngle(std::atan2(forward.y(), forward.x()));
    box.size.x() = along_u ? r.size_u() : r.size_v();
    box.size.y() = along_u ? r.size_v() : r.size_u();
}

}  // namespace

Eigen::Vector2d axisOf(const OrientedBox& box, int k) {
    const Eigen::Vector2d forward(std::cos(box.yaw), std::sin(box.yaw));
    return k == 0 ? forward : Eigen::Vector2d(-forward.y(), forward.x());
}

void turnQuarters(OrientedBox& box, int quarters) {
    if (quarters % 2 != 0) std::swap(box.size.x(), box.size.y());
    box.yaw = normalizeAngle(box.yaw + M_PI_2 * quarters);
}

void turnQuarters(Obstacle& o, int quarters) {
    constexpr std::array<Face, 4> kAround{kFront, kLeft, kBack, kRight};  // counter-clockwise
    turnQuarters(o.box, quarters);
    turnQuarters(o.seen_box, quarters);
    const std::uint8_t before = o.faces;
    const auto turn = static_cast<std::size_t>((quarters % 4 + 4) % 4);
    o.faces = 0;
    for (std::size_t k = 0; k < kAround.size(); ++k)
        if ((before & kAround[(k + turn) % kAround.size()]) != 0) o.faces |= kAround[k];
}

int countRings(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    if (cloud.ring.empty()) return 0;
    std::vector<std::uint8_t> seen(64, 0);
    for (const std::int32_t i : points) {
        if (cloud.ring[i] >= seen.size()) seen.resize(cloud.ring[i] + 1, 0);
        seen[cloud.ring[i]] = 1;
    }
    return static_cast<int>(std::count(seen.begin(), seen.end(), 1));
}

CroppedCluster::CroppedCluster(const Cluster& c, const PointCloud& scan, const GroundModel& scan_ground)
    : cluster(c),
      cloud(scan),
      ground(scan_ground),
      viewpoint(viewpointOf(c.points, scan)),
      points(seenFromAbove(c.points, scan, viewpoint)) {
    if (c.points.empty()) throw std::invalid_argument("a box for a cluster without returns");
}

Obstacle boxOf(const CroppedCluster& c, const Orientation& orientation, const BoxParams& params) {
    const Rectangle r = enclose(c.points, orientation.angle, params.face_distance);
    const Vec2 sensor = c.viewpoint.cast<double>();
    Obstacle o;
    o.num_points = static_cast<int>(c.cluster.points.size());
    o.num_rings = countRings(c.cluster.points, c.cloud);
    o.points = c.cluster.points;
    o.box.center.head<2>() = sensor + r.center();
    setHeights(c, o);
    setFootprint(r, lengthIsAlongU(r, o.box.size.z(), params), o.box);
    o.heading_valid =
        orientation.rule != HeadingRule::None && orientation.support >= 3 && orientation.angle_std < kMaxHeadingStd;
    if (!o.heading_valid && o.box.size.x() < o.box.size.y()) turnQuarters(o.box, 1);
    o.rule = o.heading_valid ? orientation.rule : HeadingRule::None;
    o.heading_std = o.heading_valid ? orientation.angle_std : 0.0;
    o.faces = facesWithReturns(c.points, o, r.center(), params.face_distance);
    for (const Vec2& m : orientation.marks) o.marks.push_back(sensor + m);
    return o;
}

}  // namespace lidar_obstacles
