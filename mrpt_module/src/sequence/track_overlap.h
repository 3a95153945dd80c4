// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How well two boxes cover each other, on the ground and as seen from the sensor.
#pragma once

#include "sequence/track_view.h"

namespace lidar_obstacles {

/// Area that two boxes share [m2].
double sharedArea(const FlatBox& a, const FlatBox& b);
/// Whether a body covers more than 0.7 of a box's area.
bool mostlyWithin(const FlatBox& box, const FlatBox& body);
/// Whether two boxes are more than 0.5 m apart.
bool standApart(FlatBox a, const FlatBox& b);
/// Generalised intersection over union (Rezatofighi et al. 2019): -1 (far apart) .. 1 (the same).
double generalisedIou(const FlatBox& a, const FlatBox& b);
/// Intersection over union of the angles that two boxes cover, 0 .. 1; both seen from one place.
double polarOverlap(const PlacedBox& a, const PlacedBox& b);

}  // namespace lidar_obstacles
