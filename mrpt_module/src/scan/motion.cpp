// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/motion.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace lidar_obstacles {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// The pose at a share of the way from a to b; shares beyond 1 go on at the same rate.
Eigen::Isometry3d between(const StampedPose& a, const StampedPose& b, double share) {
    const Eigen::Quaterniond turn = a.orientation.conjugate() * b.orientation;  // angle-axis has no limit at share 1
    Eigen::AngleAxisd about(turn.w() < 0.0 ? Eigen::Quaterniond(-turn.coeffs()) : turn);
    about.angle() *= share;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (a.orientation * about).toRotationMatrix();
    pose.translation() = a.position + share * (b.position - a.position);
    return pose;
}

/// How far the heading changed [rad]. Not the tilt: that is known from gravity and does not jump, but a kerb jolts it.
double turnBetween(const StampedPose& a, const StampedPose& b) {
    const Eigen::Quaterniond turn = b.orientation * a.orientation.conjugate();
    return 2.0 * std::atan2(std::abs(turn.z()), std::abs(turn.w()));
}

bool earlier(const StampedPose& a, const StampedPose& b) { return a.time < b.time; }

}  // namespace

const char* toString(PoseFound found) {
    switch (found) {
        case PoseFound::At:
            return "at";
        case PoseFound::Extrapolated:
            return "extrapolated";
        case PoseFound::Outside:
            return "outside";
        case PoseFound::Gap:
            return "gap";
        case PoseFound::Jump:
            return "jump";
        case PoseFound::NoPoses:
            break;
    }
    return "no_poses";
}

void validate(const StampedPose& pose) {
    const bool finite = std::isfinite(pose.time) && pose.position.allFinite() && pose.orientation.coeffs().allFinite();
    if (finite && pose.orientation.norm() > 1e-6) return;
    std::ostringstream text;
    text.precision(16);
    text << "pose with the time stamp " << pose.time << " is not finite: position " << pose.position.transpose()
         << ", orientation " << pose.orientation.coeffs().transpose();
    throw std::invalid_argument(text.str());
}

bool Trajectory::add(StampedPose pose) {
    validate(pose);
    pose.orientation.normalize();
    const auto at = std::lower_bound(poses_.begin(), poses_.end(), pose, earlier);
    if (at != poses_.end() && at->time == pose.time) return false;
    poses_.insert(at, pose);
    return true;
}

void Trajectory::forgetBefore(double time) {
    const auto at = std::lower_bound(poses_.begin(), poses_.end(), StampedPose{time, {}, {}, false}, earlier);
    if (at - poses_.begin() > 2) poses_.erase(poses_.begin(), at - 2);
}

void Trajectory::forgetAfter(double time) {
    poses_.erase(std::upper_bound(poses_.begin(), poses_.end(), StampedPose{time, {}, {}, false}, earlier),
                 poses_.end());
}

std::optional<PoseFound> Trajectory::broken(const StampedPose& a, const StampedPose& b) const {
    const double seconds = b.time - a.time;
    if (seconds > params_.max_gap) return PoseFound::Gap;
    // the slack is for the noise of poses that follow each other closely
    constexpr double kSlack = 0.3;
    constexpr double kTurnSlack = 2.0 * kDegree;
    const double way = a.rotation_only ? 0.0 : (b.position - a.position).norm();
    const double turn = turnBetween(a, b);
    const bool jump = way > params_.max_speed * seconds + kSlack ||
                      turn > params_.max_turn_deg * kDegree * seconds + kTurnSlack ||
                      a.rotation_only != b.rotation_only;
    return jump ? std::optional(PoseFound::Jump) : std::nullopt;
}

PoseAt Trajectory::at(double time) const {
    if (poses_.empty()) return {PoseFound::NoPoses, std::nullopt};
    const auto next = std::lower_bound(poses_.begin(), poses_.end(), StampedPose{time, {}, {}, false}, earlier);
    if (next == poses_.end()) return extrapolate(time);
    if (next->time == time) return {PoseFound::At, between(*next, *next, 0.0)};
    if (next == poses_.begin()) return {PoseFound::Outside, std::nullopt};
    const StampedPose& before = *(next - 1);
    if (const auto reason = broken(before, *next)) return {*reason, std::nullopt};
    return {PoseFound::At, between(before, *next, (time - before.time) / (next->time - before.time))};
}

PoseAt Trajectory::extrapolate(double time) const {
    const StampedPose& last = poses_.back();
    if (time - last.time > params_.max_extrapolation || poses_.size() < 2) return {PoseFound::Outside, std::nullopt};
    // velocity over a tenth of a second, as far as the poses hang together: over less it is their noise
    auto from = poses_.end() - 2;
    if (const auto reason = broken(*from, last)) return {*reason, std::nullopt};
    while (from != poses_.begin() && last.time - from->time < 0.099 && !broken(*(from - 1), *from)) --from;
    return {PoseFound::Extrapolated, between(*from, last, (time - from->time) / (last.time - from->time))};
}

bool Trajectory::brokenBetween(double from, double to) const {
    if (from > to) return true;
    const auto begin = std::upper_bound(poses_.begin(), poses_.end(), StampedPose{from, {}, {}, false}, earlier);
    const auto end = std::lower_bound(poses_.begin(), poses_.end(), StampedPose{to, {}, {}, false}, earlier);
    const auto first = begin == poses_.begin() ? begin : begin - 1;
    const auto last = end == poses_.end() ? end : end + 1;
    for (auto it = first; it != last && it + 1 != last; ++it)
        if (broken(*it, *(it + 1))) return true;
    return false;
}

}  // namespace lidar_obstacles
