// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a box's class says about the box.
#pragma once

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

inline bool isPerson(ObstacleClass cls) { return cls == ObstacleClass::Pedestrian || cls == ObstacleClass::Cyclist; }
/// The likeliest class; the first of several.
ObstacleClass topClass(const ClassProbabilities& classes);
/// How probable it is that an obstacle is of its class; 0 where classes were told by size.
inline float probabilityOf(const Obstacle& o) { return o.probability[static_cast<std::size_t>(o.cls)]; }
inline bool isRoadUser(ObstacleClass cls) { return cls == ObstacleClass::Vehicle || isPerson(cls); }

/// No class is less likely than that after one look, whatever the look says.
constexpr double kRarestInOneLook = 0.02;

/// What an obstacle is to be called: Unknown in the place of a road user of fewer returns than
/// `gates.min_points_vehicle`, `_pedestrian` or `_cyclist` of its class, of which more is seen (seen_box) than
/// `gates.max_length_vehicle`, `_pedestrian` or `_cyclist`, or which is less probable than `gates.min_probability`;
/// else its class. What a track predicts has no returns: only its probability counts.
ObstacleClass toldClass(const Obstacle& obstacle, const GateParams& params);

/// Makes the box fit its class. A person has no heading: its sides tell nothing of where it goes (Sec. IV). A rider's
/// is along the ride: the longer side, and only where that is clearly the longer one. Vehicles and what is unknown
/// stay.
void applyClass(Obstacle& obstacle);

}  // namespace lidar_obstacles
