// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_view.h"

#include <algorithm>
#include <cmath>

#include "sequence/track_belief.h"

namespace lidar_obstacles {
namespace {

constexpr double kGrown = 0.02;  // by so much a completed box is larger than what was seen [m]

/// Which faces of a box the laser saw, and where the returns merely end.
std::array<EdgeGrade, kFaces> gradesOf(const SeenBox& box) {
    constexpr std::array<Face, kFaces> kBits{kFront, kLeft, kBack, kRight};
    std::array<EdgeGrade, kFaces> grade{};
    grade.fill(EdgeGrade::Silhouette);
    if (box.faces == 0 || !box.heading_valid) return grade;
    for (std::size_t k = 0; k < kFaces; ++k) {
        if ((box.faces & kBits[k]) != 0) grade[k] = EdgeGrade::Seen;
    }
    for (std::size_t k = 0; k < kFaces; ++k) {
        const auto axis = static_cast<int>(k % 2);
        const bool grown = box.box.size[axis] > box.seen_box.size[axis] + kGrown;
        const bool opposite_seen = grade[(k + 2) % kFaces] == EdgeGrade::Seen;
        const bool side_seen = (box.faces & (kBits[(k + 1) % kFaces] | kBits[(k + 3) % kFaces])) != 0;
        if (grade[k] != EdgeGrade::Seen && opposite_seen && (grown || !side_seen)) grade[k] = EdgeGrade::Guess;
    }
    return grade;
}

FlatBox flatten(const OrientedBox& box, const Eigen::Isometry3d& T_world_vehicle) {
    const Eigen::Vector3d ahead = T_world_vehicle.linear() * Eigen::Vector3d(std::cos(box.yaw), std::sin(box.yaw), 0.0);
    return {(T_world_vehicle * box.center).head<2>(), 0.5 * box.size.head<2>(), std::atan2(ahead.y(), ahead.x())};
}

}  // namespace

Eigen::Vector2d FlatBox::axis(std::size_t face) const {
    const double angle = yaw + M_PI_2 * static_cast<double>(face);
    return {std::cos(angle), std::sin(angle)};
}

std::array<Eigen::Vector2d, 4> FlatBox::corners() const {
    const Eigen::Vector2d a = half.x() * axis(0);
    const Eigen::Vector2d b = half.y() * axis(1);
    return {center + a + b, center - a + b, center - a - b, center + a - b};
}

void lookAt(PlacedBox& box) {
    const Eigen::Vector2d middle = box.whole.center - box.sensor;
    box.bearing = std::atan2(middle.y(), middle.x());
    const auto corners = box.whole.corners();
    box.half_angle = 0.0;
    for (const Eigen::Vector2d& corner : corners) {
        const Eigen::Vector2d d = corner - box.sensor;
        box.half_angle = std::max(box.half_angle, std::abs(normalizeAngle(std::atan2(d.y(), d.x()) - box.bearing)));
    }
    const Eigen::Vector2d local(std::abs(middle.dot(box.whole.axis(0))), std::abs(middle.dot(box.whole.axis(1))));
    box.range = (local - box.whole.half).cwiseMax(0.0).norm();
}

PlacedBox placeBox(const SeenBox& box, const Eigen::Vector2d& sensor, const TrackingParams& params) {
    constexpr double kDegree = M_PI_2 / 90.0;
    constexpr double kMinHeadingStd = kDegree;  // what a fit says of itself leaves out what the body is not: a box
    constexpr double kGoodView = 50.0;          // returns
    constexpr double kSlide = 1.0;              // one ring climbs bonnets and roofs as the sensor comes nearer [m]
    PlacedBox p;
    p.whole = flatten(box.box, box.T_world_vehicle);
    p.seen = flatten(box.seen_box, box.T_world_vehicle);
    p.grade = gradesOf(box);
    p.height = box.box.size.z();
    p.bottom = (box.T_world_vehicle * box.box.center).z() - 0.5 * p.height;
    p.sensor = (box.T_world_vehicle * Eigen::Vector3d(sensor.x(), sensor.y(), box.box.center.z())).head<2>();
    if (box.heading_valid)
        p.heading_std =
            box.heading_std > 0.0 ? std::hypot(box.heading_std, kMinHeadingStd) : params.heading_std_deg * kDegree;
    if (box.num_rings == 1 && topClass(box.classes) == ObstacleClass::Vehicle) p.depth_std = kSlide;
    p.quality = std::clamp(box.num_points / kGoodView, 0.1, 1.0);
    p.source = &box;
    lookAt(p);
    return p;
}

BoxView viewOf(const PlacedBox& box, const Eigen::Vector2d& position, double yaw) {
    constexpr double kFarOff = 0.35;  // a heading farther off may be another line, e.g. a diagonal [rad]
    BoxView v;
    v.ends = box.ends;
    v.quarters = static_cast<int>(std::lround((yaw - box.seen.yaw) / M_PI_2));
    const double nearest = box.seen.yaw + M_PI_2 * v.quarters;
    v.heading = box.heading_std > 0.0;
    v.yaw_innovation = nearest - yaw;
    v.yaw_fits = v.heading && std::abs(v.yaw_innovation) < kFarOff;
    const double axes = v.yaw_fits ? nearest : yaw;
    for (std::size_t k = 0; k < kFaces; ++k) {
        const double angle = axes + M_PI_2 * static_cast<double>(k);
        const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
        const std::size_t of_box = (k + static_cast<std::size_t>(((v.quarters % 4) + 4) % 4)) % kFaces;
        v.normal[k] = n;
        v.grade[k] = v.yaw_fits ? box.grade[of_box] : EdgeGrade::Silhouette;
        const FlatBox& from = v.grade[k] == EdgeGrade::Guess ? box.whole : box.seen;
        v.edge[k] = n.dot(from.center - position) + from.half[static_cast<int>(of_box % 2)];
        v.tangent[k] = Eigen::Vector2d(-n.y(), n.x()).dot(box.seen.center - position);
    }
    return v;
}

namespace {

/// One axis of a view: how far its two edges lie from where the body's are, positive along the axis [m].
struct AxisView {
    double ahead = 0.0;
    double behind = 0.0;
    bool ahead_seen = false;
    bool behind_seen = false;
};

/// A face that lies within the body, farther than errors go, is the end of what something before it leaves to be seen.
void dropEndsOfView(AxisView& axis, double std) {
    constexpr double kSurely = 3.0;
    if (axis.ahead_seen && axis.ahead < -kSurely * std) axis.ahead_seen = false;
    if (axis.behind_seen && axis.behind > kSurely * std) axis.behind_seen = false;
}

}  // namespace

Measurements measure(const BoxView& view, const BodyShape& shape, const PlacedBox& box, const ViewNoise& noise) {
    const double plain_std = noise.face_std + noise.face_std_per_metre * box.range;
    const Eigen::Vector2d slide = box.depth_std * (box.whole.center - box.sensor).normalized();
    const double turned = view.yaw_fits ? -view.yaw_innovation : 0.0;  // the track's axes, from the box's
    const double c = std::cos(turned), s = std::sin(turned);
    const auto expected = [&](std::size_t k) { return shape.face(k) * c - view.tangent[k] * s; };
    Measurements out;
    for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t back = k + 2;
        const Eigen::Vector2d& n = view.normal[k];
        const double face_std = std::hypot(plain_std, n.dot(slide));
        AxisView axis{view.edge[k] - expected(k), -(view.edge[back] - expected(back)), view.grade[k] == EdgeGrade::Seen,
                      view.grade[back] == EdgeGrade::Seen};
        dropEndsOfView(axis, std::sqrt(face_std * face_std + n.dot(noise.position * n)));
        Measurement m;
        m.row.head<2>() = n;
        if (view.yaw_fits) m.row[kYaw] = -view.tangent[k];
        if (axis.ahead_seen != axis.behind_seen) {
            const double where_std = shape.faceStd(axis.ahead_seen ? k : back);
            m.innovation = axis.ahead_seen ? axis.ahead : axis.behind;
            m.variance = face_std * face_std + where_std * where_std;
        } else {
            // anywhere that keeps the smaller of the two, what was seen and the body, within the larger
            const double edge_std = axis.ahead_seen ? face_std : 2.0 * face_std;
            const double slack = std::max(0.0, 0.5 * std::abs(axis.ahead - axis.behind) - edge_std);
            const double middle = 0.5 * (axis.ahead + axis.behind);
            const double size_std = 0.5 * std::hypot(shape.faceStd(k), shape.faceStd(back));
            m.innovation = middle - std::clamp(middle, -slack, slack);
            m.variance = edge_std * edge_std + size_std * size_std + slack * slack / 3.0;
        }
        out.add(m);
    }
    if (view.heading) {
        Measurement m;
        m.row[kYaw] = 1.0;
        m.innovation = view.yaw_innovation;
        m.variance = box.heading_std * box.heading_std;
        out.add(m);
    }
    return out;
}

void learnShape(BodyShape& shape, const BoxView& view, double quality, bool begin) {
    if (view.heading && !view.yaw_fits) quality *= 0.1;  // the edges of another rectangle
    for (std::size_t k = 0; k < 2; ++k) {
        const BodyAxis::View axis{
            {view.edge[k], view.edge[k + 2]}, {view.grade[k], view.grade[k + 2]}, quality, view.ends[k]};
        if (begin)
            shape.axis(k).begin(axis);
        else
            shape.axis(k).learn(axis);
    }
}

}  // namespace lidar_obstacles
