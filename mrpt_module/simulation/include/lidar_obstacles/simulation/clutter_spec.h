// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What stands beside the track, as data: a part of a scenario.
#pragma once

#include <cstdint>

namespace lidar_obstacles::simulation {

enum class ClutterKind : std::uint8_t {
    Tree,
    Bush,
    Pole,
    Bollard,
    Bin,
    Sign,
    Bike,
    Building,
    Step,
    Ramp,
    Wall,
    Fence,
    Hedge,
    Rail,
    Kerb,
    Sidewalk,
    Bridge,
    // Plants with `leaves` only:
    Shrub,  ///< cut into a ball, a cone or a box
    Reed,   ///< tall grass, stalks
    // In one place, turned to `yaw`:
    OpenWall,  ///< with doors and windows open
    Panel,     ///< a piece of a fence
    Scaffold,
    Stairs,
    Barrier,  ///< of concrete
    Bench,
    Table,
    Kiosk,
    Shelter,  ///< of a bus stop
    Cabinet,
    Planter,
    Carts,  ///< shopping trolleys
    Crate,
    Skip,
    Pile,
    Scooter,
    Lamp,
    Board,
    Cone,
};

/// Something that stands: at `from`, or for walls and the like from `from` to `to`.
struct ClutterSpec {
    ClutterKind kind = ClutterKind::Pole;
    double from = 0.0, to = 0.0, d = 0.0, yaw = 0.0;
    double length = 0.0, width = 0.0, height = 0.0;  ///< [m]; a bridge's height is its clearance
    std::uint64_t variant = 0;                       ///< makes trees differ
    /// Of plants: how deep beams get into them on average [m], from 0.01 (trimmed) to 1 (open); 0: only a rough shell.
    double leaves = 0.0;
    double roughness = 0.05;  ///< of plants with leaves and of heaps: standard deviation of the surface [m]
};

}  // namespace lidar_obstacles::simulation
