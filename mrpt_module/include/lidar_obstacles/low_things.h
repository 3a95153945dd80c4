// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a small robot must not drive onto although it is lower than an obstacle: kerbs, low things, and where the
/// ground ends.
///
/// Beside the boxes and without a say in them. The ground next to the vehicle is looked at step by step: from return to
/// return along a ring, and from ring to ring.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/obstacle.h"
#include "lidar_obstacles/params.h"

namespace lidar_obstacles {

struct PointCloud;
struct GroundModel;

enum class LowKind : std::uint8_t {
    Raised,   ///< a step up: a kerb, a thing that lies there
    Drop,     ///< the ground ends, and beams were seen to reach below it: stairs down, the edge of a platform
    NoGround  ///< beams that should meet the ground came back from nowhere: a deep hole, or water
};

/// From where to where along one beam, seen from above [m].
struct LowSpan {
    Eigen::Vector2f from = Eigen::Vector2f::Zero(), to = Eigen::Vector2f::Zero();
};

/// One step, drop or hole. Vehicle frame.
struct LowThing {
    LowKind kind = LowKind::Raised;
    double height = 0.0;               ///< of its highest return above the ground, a drop's lowest: negative [m]
    OrientedBox box;                   ///< around its spans, seen from above; z from the ground to `height`
    std::vector<std::int32_t> points;  ///< its returns (indices into the cloud); none where there is no ground
    /// Raised: its returns. Drop: from the last ground that was seen to where the beam met something below. NoGround:
    /// from the last ground to where the next one should have been.
    std::vector<LowSpan> spans;
    double age = 0.0;  ///< since it was seen last [s]; above 0 it is remembered (detector.h), and has no returns
};

/// What is low or missing around a vehicle.
///
/// @param cloud   with a view; without one nothing is found. Returns on the own body (`region.own_body`) do not count.
/// @param ground  of this cloud. Without evidence nothing is found.
/// @return nearest first. What reaches higher than `gates.min_top` is an obstacle, and not listed.
std::vector<LowThing> findLowThings(const PointCloud& cloud, const GroundModel& ground, const DetectorParams& params);

/// "raised", "drop" or "no_ground".
const char* toString(LowKind kind);

}  // namespace lidar_obstacles
