// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How fast to go on straight ahead among things that move: tracks are carried on at their velocities, zones have a
/// veto.
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"
#include "lidar_obstacles/zones.h"

namespace lidar_obstacles::examples {

/// The robot seen from above, and how it moves.
struct RobotBody {
    double length = 0.9, width = 0.6;  ///< [m]
    double fastest = 2.0;              ///< [m/s]
    double backwards = 0.8;            ///< [m/s]
    double acceleration = 1.5;         ///< [m/s^2]
};

/// Where it is on its way.
struct WayState {
    double speed = 0.0;        ///< [m/s]
    double to_road = 0.0;      ///< from its front to the roadway [m]; negative: on it or beyond
    double to_far_side = 0.0;  ///< from its rear to the end of the roadway [m]; negative: it has left it
    double to_goal = 0.0;      ///< [m]
};

/// What a step of the plan was chosen by.
enum class Choice { Go, Wait, Evade };

struct PlannedSpeed {
    double speed = 0.0;  ///< [m/s]
    Choice choice = Choice::Wait;
};

/// The zones that the planner asks, around a robot of this body: "ahead" must be free to go on, "left" and "right", the
/// roadway beside it, must be seen to begin.
ZoneSet crossingZones(const RobotBody& body);

/// The speed to aim for. Each of a few speeds is tried: where the robot would be every tenth of a second, and where all
/// obstacles would be then, each made larger by what its velocity may be wrong by. The fastest that comes near to
/// nothing is taken; from where nothing stands in the way a robot begins only if it can leave the roadway again.
/// @param obstacles  of the last scan, tracks with velocities; vehicle frame, the way is along x.
PlannedSpeed planSpeed(const RobotBody& body, const WayState& state, const std::vector<Obstacle>& obstacles,
                       const ZoneMonitor& zones);

}  // namespace lidar_obstacles::examples
