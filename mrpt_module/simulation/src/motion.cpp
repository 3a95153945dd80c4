// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lidar_obstacles::simulation {
namespace {

constexpr double kHalfChord = 0.02;   ///< direction of travel is taken over twice that [s]
constexpr double kStandstill = 1e-7;  ///< shorter chords have no direction [m]

Curve curveOf(const std::vector<Waypoint>& waypoints, double Waypoint::* value) {
    std::vector<Curve::Knot> knots;
    knots.reserve(waypoints.size());
    for (const Waypoint& w : waypoints) knots.push_back({w.t, w.*value});
    return Curve(std::move(knots));
}

/// Distance from the origin to a box of half sizes `half` at `center`, turned by `yaw`.
double distanceToBox(const Eigen::Vector2d& center, double yaw, const Eigen::Vector2d& half) {
    const Eigen::Vector2d local = Eigen::Rotation2Dd(-yaw) * center;
    return (local.cwiseAbs() - half).cwiseMax(0.0).norm();
}

/// How far out along `bearing` the box's centre is for the box to be `range` away; found by bisection.
double centerDistance(double range, double bearing, double yaw, const Eigen::Vector2d& half) {
    const Eigen::Vector2d ray(std::cos(bearing), std::sin(bearing));
    double low = 0.0, high = range + half.norm() + 1.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (distanceToBox(middle * ray, yaw, half) < range ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace

Path::Path(std::shared_ptr<const Track> track, const std::vector<Waypoint>& waypoints, const Curve& lead)
    : track_(std::move(track)),
      s_(curveOf(waypoints, &Waypoint::s)),
      d_(curveOf(waypoints, &Waypoint::d)),
      lead_(lead) {
    for (const Waypoint& w : waypoints) times_.push_back(w.t);
}

Eigen::Vector2d Path::position(double t) const { return track_->place(s_(t) + lead_(t), d_(t)); }

/// Direction of travel about t, looking no further than the leg from `from` to `to`.
std::optional<double> Path::yawWithin(double t, double from, double to) const {
    const double before = std::max(from, std::min(t, to) - kHalfChord),
                 after = std::min(to, std::max(t, from) + kHalfChord);
    const Eigen::Vector2d chord = position(after) - position(before);
    if (chord.norm() < kStandstill) return std::nullopt;
    return std::atan2(chord.y(), chord.x());
}

/// Yaw on a leg without travel: of the legs before it the nearest that has one, at its end; else of those after it.
double Path::waitingYaw(std::size_t leg) const {
    for (std::size_t i = leg; i-- > 1;)
        if (const auto yaw = yawWithin(times_[i], times_[i - 1], times_[i])) return *yaw;
    for (std::size_t i = std::max<std::size_t>(leg, 1); i < times_.size(); ++i)
        if (const auto yaw = yawWithin(times_[i - 1], times_[i - 1], times_[i])) return *yaw;
    return track_->at(s_(times_.front()) + lead_(times_.front())).heading;
}

PlanarPose Path::at(double t) const {
    const auto leg = static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), t) - times_.begin());
    PlanarPose pose;
    pose.position = position(t);
    const bool led = lead_.firstX() < lead_.lastX();
    std::optional<double> yaw;
    if (led)
        yaw = yawWithin(t, t - kHalfChord, t + kHalfChord);
    else if (leg > 0 && leg < times_.size())
        yaw = yawWithin(t, times_[leg - 1], times_[leg]);
    if (led && !yaw) yaw = track_->at(s_(t) + lead_(t)).heading;
    pose.yaw = yaw ? *yaw : waitingYaw(leg);
    return pose;
}

bool Path::isMoving(double t) const { return (position(t + 0.05) - position(t - 0.05)).norm() > 0.01; }

PlanarPose poseOf(const Motion& motion, double t, std::size_t scan) {
    if (const auto* fixed = std::get_if<PlanarPose>(&motion)) return *fixed;
    if (const auto* path = std::get_if<Path>(&motion)) return path->at(t);
    const auto& poses = std::get<PosePerScan>(motion).poses;
    return poses[std::min(scan, poses.size() - 1)];
}

PosePerScan gridPoses(const Gridded& grid, const PlanarPose& ego, const Eigen::Vector2d& box) {
    PosePerScan result;
    for (double range : grid.ranges)
        for (double bearing : grid.bearings)
            for (double yaw : grid.yaws) {
                const double distance = centerDistance(range, bearing, yaw, 0.5 * box);
                const double direction = ego.yaw + bearing;
                result.poses.push_back(
                    {ego.position + distance * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                     ego.yaw + yaw});
            }
    return result;
}

}  // namespace lidar_obstacles::simulation
