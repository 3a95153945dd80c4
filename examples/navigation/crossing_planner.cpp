// SPDX-License-Identifier: BSD-3-Clause
#include "crossing_planner.h"

#include <algorithm>
#include <cmath>

#include "simulated_lidar.h"

namespace lidar_obstacles::examples {
namespace {

constexpr double kStep = 0.1;       ///< of the look ahead [s]
constexpr double kHorizon = 7.0;    ///< longer than a crossing takes [s]
constexpr double kApart = 0.4;      ///< to keep from everything [m]
constexpr double kMostDoubt = 1.5;  ///< what a velocity may be wrong by adds no more than this [m]

/// An obstacle that goes on as it does.
struct Moved {
    OrientedBox box;
    Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
    double doubt = 0.0;  ///< error of the velocity [m/s]

    OrientedBox at(double t) const {
        OrientedBox there = box;
        there.center.head<2>() += t * velocity;
        return there;
    }
};

std::vector<Moved> movedOf(const std::vector<Obstacle>& obstacles) {
    std::vector<Moved> all;
    all.reserve(obstacles.size());
    for (const Obstacle& o : obstacles) {
        Moved m{o.box, Eigen::Vector2d::Zero(), 0.0};
        if (o.cls != ObstacleClass::Structure && o.track && o.track->velocity) {
            m.velocity = *o.track->velocity;
            m.doubt = o.track->velocity_std.maxCoeff();
        }
        all.push_back(m);
    }
    return all;
}

/// The time until something comes too near if the robot aims for a speed; kHorizon if nothing does before the robot is
/// where it can stay.
double timeToTrouble(const RobotBody& body, const WayState& state, const std::vector<Moved>& moved, double aim) {
    double x = 0.0, speed = state.speed;
    for (double t = kStep; t < kHorizon; t += kStep) {
        const double change = body.acceleration * kStep;
        speed += std::clamp(aim - speed, -change, change);
        if (x >= state.to_goal) return kHorizon;
        x += kStep * speed;
        const OrientedBox self{{x, 0.0, 0.3}, {body.length, body.width, 0.6}, 0.0};
        for (const Moved& m : moved) {
            const double reach = 0.5 * m.box.size.head<2>().norm() + body.length + kApart + kMostDoubt;
            const OrientedBox there = m.at(t);
            if ((there.center.head<2>() - self.center.head<2>()).norm() > reach) continue;
            if (clearance(self, there) < kApart + std::min(kMostDoubt, m.doubt * t)) return t;
        }
    }
    return kHorizon;
}

const ZoneReport& reportOf(const ZoneMonitor& zones, const std::string& name) {
    std::size_t k = 0;
    while (zones.set().zones[k].name != name) ++k;
    return zones.reports()[k];
}

/// Road users that are not followed long enough to know where they go.
bool isSomebodyNew(const std::vector<Obstacle>& obstacles) {
    constexpr double kNear = 45.0;  // [m]
    return std::any_of(obstacles.begin(), obstacles.end(), [](const Obstacle& o) {
        const bool road_user = o.cls == ObstacleClass::Vehicle || o.cls == ObstacleClass::Cyclist;
        return road_user && o.box.center.head<2>().norm() < kNear && o.track && o.track->seen && !o.track->velocity;
    });
}

bool mayBegin(const std::vector<Obstacle>& obstacles, const ZoneMonitor& zones) {
    for (const char* side : {"left", "right"})
        if (reportOf(zones, side).state == ZoneState::Unknown) return false;
    return !isSomebodyNew(obstacles);
}

/// A stretch that it can stop in before the roadway.
bool stopsBefore(const RobotBody& body, const WayState& state, double speed) {
    return state.to_road > 0.0 && speed * speed / (2.0 * body.acceleration) + 0.3 * speed < state.to_road;
}

}  // namespace

ZoneSet crossingZones(const RobotBody& body) {
    const double front = 0.5 * body.length, half = 0.5 * body.width;
    const auto rectangle = [](double x_from, double x_to, double y_from, double y_to) {
        return Outline{{x_from, y_from}, {x_to, y_from}, {x_to, y_to}, {x_from, y_to}};
    };
    ZoneSet set;
    set.vehicle = rectangle(-front, front, -half, half);
    ZoneRule near;
    near.object_height = 0.9;
    near.min_seen = 0.8;
    near.off_after = 0.3;
    set.zones.push_back(
        {"ahead", ZoneFrame::Vehicle, rectangle(front + 0.1, front + 0.9, -half - 0.1, half + 0.1), near});
    ZoneRule far;
    far.object_height = 1.4;
    far.min_seen = 0.6;
    far.off_after = 0.2;
    set.zones.push_back({"left", ZoneFrame::Vehicle, rectangle(1.0, 6.5, 2.0, 30.0), far});
    set.zones.push_back({"right", ZoneFrame::Vehicle, rectangle(1.0, 6.5, -30.0, -2.0), far});
    return set;
}

PlannedSpeed planSpeed(const RobotBody& body, const WayState& state, const std::vector<Obstacle>& obstacles,
                       const ZoneMonitor& zones) {
    const std::vector<Moved> moved = movedOf(obstacles);
    const bool ahead_free = reportOf(zones, "ahead").state == ZoneState::Free;
    const bool on_road = state.to_road <= 0.0 && state.to_far_side > 0.0;
    const bool begins = state.to_road > 0.0 && state.to_road < 1.5;
    PlannedSpeed best{0.0, Choice::Wait};
    double latest = -1.0;
    for (const double aim : {body.fastest, 0.75 * body.fastest, 0.4 * body.fastest, 0.0, -body.backwards}) {
        if (aim > 0.0 && !ahead_free) continue;
        if (aim > 0.0 && begins && !stopsBefore(body, state, aim) && !mayBegin(obstacles, zones)) continue;
        const double trouble = timeToTrouble(body, state, moved, aim);
        if (trouble >= kHorizon && (aim > 0.0 || aim == 0.0)) return {aim, aim > 0.0 ? Choice::Go : Choice::Wait};
        if (aim >= 0.0 && !on_road && stopsBefore(body, state, aim) && trouble > 3.0)
            return {aim, aim > 0.0 ? Choice::Go : Choice::Wait};
        if (trouble > latest + 0.05) {
            latest = trouble;
            best = {aim, Choice::Evade};
        }
    }
    return best;
}

}  // namespace lidar_obstacles::examples
