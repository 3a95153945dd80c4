// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Overlap and distance of upright boxes.
#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::evaluation {

/// Area that the footprints of two boxes share [m2]; 0 where a size is not positive or a number is not finite.
double sharedArea(const OrientedBox& a, const OrientedBox& b);

/// Shared area / area of the union of the footprints, 0 .. 1; 0 where neither has an area.
double bevIou(const OrientedBox& a, const OrientedBox& b);

/// Shared volume / volume of the union, 0 .. 1; 0 where neither has a volume.
double iou3d(const OrientedBox& a, const OrientedBox& b);

/// Distance from the vehicle's origin to the nearest point of the footprint [m], the paper's obstacle distance
/// (Sec. V); 0 inside.
double nearestFaceDistance(const OrientedBox& box);

/// The box with its footprint `margin` [m] larger to every side.
OrientedBox grown(const OrientedBox& box, double margin);

/// An angle error into (-period / 2, period / 2] [rad].
double wrapAngle(double angle, double period);

}  // namespace lidar_obstacles::evaluation
