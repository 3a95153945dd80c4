// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lidar_obstacles/object_models.h"
#include "objects/box.h"

namespace lidar_obstacles {
namespace {

constexpr double kMinStep = 1e-3;     ///< two sights of one thing on either side of the seam [s]
constexpr double kYoungYawStd = 0.2;  ///< first headings are of bad views: far away, coming into sight [rad]
constexpr double kKeepHeight = 0.98;  ///< some 50 views are remembered
constexpr double kMostHeading = 3.0;
constexpr double kSure = 2.0;  ///< standard deviations that a speed is off 0 to be believed

/// Whether bodies of this class roll where they point.
bool rolls(ObstacleClass cls) { return cls == ObstacleClass::Vehicle || cls == ObstacleClass::Cyclist; }

Eigen::Vector2d turned(const Eigen::Vector2d& v, double yaw) {
    return {std::cos(yaw) * v.x() - std::sin(yaw) * v.y(), std::sin(yaw) * v.x() + std::cos(yaw) * v.y()};
}

}  // namespace

MotionNoise motionNoiseOf(ObstacleClass cls) {
    switch (cls) {
        case ObstacleClass::Pedestrian:
            return {1.0, 1.0, 1.0, 0.1, 1.5};
        case ObstacleClass::Cyclist:
            return {2.0, 1.5, 0.6, 0.1, 5.0};
        case ObstacleClass::Structure:
            return {1.0, 1.0, 0.2, 0.2, 3.0};
        case ObstacleClass::Vehicle:
        case ObstacleClass::Unknown:
            break;
    }
    return {3.0, 1.5, 0.5, 0.1, 12.0};
}

ViewNoise viewNoise(const TrackingParams& params, const MotionFilter& motion) {
    return {params.face_std, params.face_std_per_metre, motion.covariance().topLeftCorner<2, 2>()};
}

void Track::begin(int number, const PlacedBox& box) {
    *this = Track{};
    const SeenBox& seen = *box.source;
    id = number;
    born = time = last_seen = last_look = seen.time;
    born_at = box.seen.center;
    hits = 1;
    cls.look(seen.classes, 0.0, box.quality);
    motion.begin(box.seen.center, box.seen.yaw, std::max(kYoungYawStd, box.heading_std), motionNoiseOf(cls.best()));
    const BoxView view = viewOf(box, box.seen.center, box.seen.yaw);
    learnShape(shape, view, box.quality, true);
    height.add(box.height, box.quality, kKeepHeight);
    bottom = box.bottom;
    heading_weight = seen.heading_valid ? 1.0 : -1.0;
}

MotionFilter Track::predicted(double at) const {
    MotionFilter later = motion;
    later.predict(std::max(kMinStep, at - time), motionNoiseOf(cls.best()));
    return later;
}

void Track::goOn(double at) {
    motion.predict(std::max(kMinStep, at - time), motionNoiseOf(cls.best()), source < 0 && rolls(cls.best()));
    time = std::max(at, time + kMinStep);
}

void Track::look(const ClassProbabilities& classes, double at, double quality) {
    cls.look(classes, std::max(kMinStep, at - last_look), quality);
    last_look = std::max(last_look, at);
}

void Track::take(const PlacedBox& box, const TrackingParams& params, bool over_ground) {
    constexpr double kSlide = 0.3;  // what a wheel gives way to the side, and the error of where the axle is [m/s]
    const double at = box.source->time;
    const double dt = std::max(kMinStep, at - time);
    goOn(at);
    const BoxView view = viewOf(box, motion.position(), motion.yaw());
    const double wider = motion.update(measure(view, shape, box, viewNoise(params, motion)));
    ++hits;
    last_seen = at;
    look(box.source->classes, at, box.quality);
    heading_weight = std::clamp(heading_weight + (box.source->heading_valid ? 1.0 : -1.0), -kMostHeading, kMostHeading);
    if (over_ground && rolls(cls.best()) && hasHeading()) motion.rollAlongYaw(kSlide);
    learn(box, wider);
    if (over_ground) learnFromMotion(dt);
    proveAxis();
    turnBy(direction.takeTurn(), box);
}

/// The beliefs beside the motion, after it has taken in a box.
void Track::learn(const PlacedBox& box, double wider) {
    constexpr double kOdd = 4.0;  // views that had to be trusted so much less teach no size
    const BoxView view = viewOf(box, motion.position(), motion.yaw());
    if (wider < kOdd) {
        learnShape(shape, view, box.quality);
        height.add(box.height, box.quality, kKeepHeight);
        bottom += std::max(0.2, 1.0 / hits) * (box.bottom - bottom);
    }
    if (view.heading) direction.see(view.quarters);
}

/// Which end is the front, and what it may be, by how it moves over the ground.
void Track::learnFromMotion(double dt) {
    const Eigen::Vector2d velocity = motion.velocity();
    if (motion.standing() < 0.5) direction.move(turned(velocity, -motion.yaw()), dt);
    cls.moved(velocity.norm() - kSure * speedStd(), (motion.position() - born_at).norm());
}

/// What is longer than vehicles of its height are wide is the length.
void Track::proveAxis() {
    const double along = shape.extent(0), across = shape.extent(1);
    const double widest = sizeLimitsOf(ObstacleClass::Vehicle, static_cast<float>(height.value())).max_width;
    if (cls.best() == ObstacleClass::Vehicle && std::max(along, across) > widest) direction.proveAxis(along >= across);
}

/// The front was elsewhere. Extents along what is another axis now are views of another box.
void Track::turnBy(int quarters, const PlacedBox& box) {
    motion.relabelYaw(M_PI_2 * quarters);
    if (quarters == 2) shape.reverse();
    if (quarters % 2 == 1) learnShape(shape, viewOf(box, motion.position(), motion.yaw()), box.quality, true);
}

bool Track::moving() const {
    return motion.standing() < 0.5 && motion.velocity().norm() > std::max(kCreeping, kSure * speedStd());
}

double Track::speedStd() const { return std::sqrt(motion.covariance().block<2, 2>(kVelX, kVelX).trace()); }

double Track::yawStd() const { return std::sqrt(motion.covariance()(kYaw, kYaw)); }

FlatBox Track::flat(const Eigen::Vector2d& position, double yaw) const {
    return {position + turned(shape.center(), yaw), 0.5 * Eigen::Vector2d(shape.extent(0), shape.extent(1)), yaw};
}

OrientedBox movedBox(OrientedBox box, const Eigen::Isometry3d& T) {
    const Eigen::Vector3d front = T.linear() * Eigen::Vector3d(std::cos(box.yaw), std::sin(box.yaw), 0.0);
    box.center = T * box.center;
    box.yaw = normalizeAngle(std::atan2(front.y(), front.x()));
    return box;
}

OrientedBox uprightOf(const FlatBox& flat, const Track& track, const Eigen::Isometry3d& T_world_vehicle) {
    const double height = track.height.value();
    const Eigen::Vector3d center(flat.center.x(), flat.center.y(), track.bottom + 0.5 * height);
    return movedBox({center, {2.0 * flat.half.x(), 2.0 * flat.half.y(), height}, flat.yaw}, T_world_vehicle.inverse());
}

TrackedBox rowOf(const Track& track, double at, const Eigen::Isometry3d& T_world_vehicle) {
    const double ahead = at - track.time;
    const MotionState& x = track.motion.mean();
    const FlatBox flat = track.flat(x.head<2>() + ahead * x.segment<2>(kVelX), x[kYaw] + ahead * x[kTurn]);
    TrackedBox row;
    row.id = track.id;
    row.source = track.source;
    row.cls = track.cls.best();
    row.classes = track.cls.probabilities();
    row.box = uprightOf(flat, track, T_world_vehicle);
    row.heading_valid = track.hasHeading();
    TrackState& s = row.state;
    s.seen = track.source >= 0;
    s.yaw_std = track.yawStd();
    const Eigen::Matrix2d R = T_world_vehicle.linear().transpose().topLeftCorner<2, 2>();
    const MotionCovariance& P = track.motion.covariance();
    const Eigen::Vector2d size_std(track.shape.faceStd(0), track.shape.faceStd(1));
    s.center_std = ((R * P.topLeftCorner<2, 2>() * R.transpose()).diagonal() + size_std.cwiseAbs2()).cwiseSqrt();
    s.time_offset = at;
    if (!track.confirmed()) return row;
    s.age = track.last_seen - track.born;
    s.velocity = R * x.segment<2>(kVelX);
    s.velocity_std = (R * P.block<2, 2>(kVelX, kVelX) * R.transpose()).diagonal().cwiseSqrt();
    s.moving = track.moving();
    s.direction_known = row.heading_valid && track.direction.known();
    return row;
}

std::vector<Obstacle> trackedObstacles(const std::vector<TrackedBox>& rows, std::vector<Obstacle>& boxes) {
    std::vector<Obstacle> out;
    out.reserve(rows.size());
    for (const TrackedBox& row : rows) {
        Obstacle o = row.source >= 0 ? std::move(boxes[static_cast<std::size_t>(row.source)]) : Obstacle{};
        if (row.source < 0) {
            o.max_height = row.box.size.z();
            o.seen_box.center = row.box.center;
            o.seen_box.yaw = row.box.yaw;
        } else {  // the same returns, on faces by the track's axes
            turnQuarters(o, static_cast<int>(std::lround(normalizeAngle(row.box.yaw - o.box.yaw) / M_PI_2)));
        }
        if (!row.heading_valid) {
            o.heading_std = 0.0;
            o.rule = HeadingRule::None;
        }
        o.id = row.id;
        o.cls = row.cls;
        o.probability = row.classes;
        o.box = row.box;
        o.heading_valid = row.heading_valid;
        o.track = row.state;
        out.push_back(std::move(o));
    }
    return out;
}

}  // namespace lidar_obstacles
