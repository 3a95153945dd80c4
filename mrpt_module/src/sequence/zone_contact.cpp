// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/zone_contact.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {
namespace {

/// Where the vehicle is at time t, in its frame of time 0: on a circle, or straight ahead.
Eigen::Isometry2d vehicleAt(const VehicleMotion& motion, double t) {
    const double turned = motion.turn_rate * t;
    Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
    T.linear() = Eigen::Rotation2Dd(turned).toRotationMatrix();
    const Eigen::Vector2d& v = motion.velocity;
    const Eigen::Vector2d left(-v.y(), v.x());
    if (std::abs(turned) < 1e-6)
        T.translation() = t * v;
    else
        T.translation() = (std::sin(turned) * v + (1.0 - std::cos(turned)) * left) / motion.turn_rate;
    return T;
}

/// No point of the thing comes nearer to the vehicle faster than this [m/s].
double fastest(const VehicleMotion& motion, const MovingThing& thing, double limit) {
    const double speeds = motion.velocity.norm() + thing.velocity.norm();
    double reach = 0.0;
    for (const Eigen::Vector2d& p : thing.outline) reach = std::max(reach, p.norm());
    return speeds + std::abs(motion.turn_rate) * (reach + limit * speeds);
}

}  // namespace

std::optional<VehicleMotion> vehicleMotion(const Trajectory& trajectory, double time) {
    if (trajectory.rotationOnly()) return std::nullopt;
    const auto now = trajectory.at(time).T_world_vehicle;
    if (!now) return std::nullopt;
    for (const double span : {0.3, 0.2, 0.1}) {
        const auto before = trajectory.at(time - span).T_world_vehicle;
        if (!before || trajectory.brokenBetween(time - span, time)) continue;
        const Eigen::Isometry2d step = seenFromAbove(before->inverse() * *now);
        const double turned = std::atan2(step.linear()(1, 0), step.linear()(0, 0));
        // half of the turn was made when half of the way was
        const Eigen::Vector2d way = Eigen::Rotation2Dd(-0.5 * turned) * step.translation();
        return VehicleMotion{way / span, turned / span};
    }
    return std::nullopt;
}

std::optional<double> timeToContact(const ZonePolygon& vehicle, const VehicleMotion& motion, const MovingThing& thing,
                                    const Eigen::Vector2d& margin_and_limit) {
    constexpr double kStep = 0.02;  // shorter steps are not worth it [s]
    const double margin = margin_and_limit[0], limit = margin_and_limit[1];
    const double speed = fastest(motion, thing, limit);
    for (double t = 0.0; t <= limit;) {
        Eigen::Isometry2d T = vehicleAt(motion, t).inverse();
        T.translation() += T.linear() * (t * thing.velocity);
        const double apart = distance(vehicle, toPolygon(moved(thing.outline, T))) - margin;
        if (apart <= 0.0) return t;
        if (apart > speed * (limit - t)) return std::nullopt;
        t += std::max(kStep, apart / speed);
    }
    return std::nullopt;
}

}  // namespace lidar_obstacles
