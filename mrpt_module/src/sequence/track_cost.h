// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What it costs to say that a box is a track's.
#pragma once

#include "sequence/track.h"
#include "sequence/track_overlap.h"

namespace lidar_obstacles {

/// Where a track should be in a scan.
struct Expectation {
    double at = 0.0;  ///< when the laser should see it [s]
    MotionFilter motion;
    ClassProbabilities classes{};
    PlacedBox box;  ///< only `whole`, and how it is seen
};

/// @param sensor  where it is at `at`, world frame [m]
Expectation expect(const Track& track, double at, const Eigen::Vector2d& sensor);

/// The body of a track at another instant of the same scan [s].
FlatBox bodyAt(const Expectation& expected, double time);

/// A pair that costs as much or more is none.
inline constexpr double kCostLimit = 9.0;

/// Half the squared distance in units of the errors, plus what speaks against it in overlap and class; kCostLimit
/// where it cannot be.
double costOf(const Track& track, const Expectation& expected, const PlacedBox& box, const TrackingParams& params);

}  // namespace lidar_obstacles
