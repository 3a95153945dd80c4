// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The one table of kinds: what can stand or move in a scan, what it is called, and the class it belongs to. The
/// simulator, the truth files, the evaluation and the recognizer all use it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What a thing is. The values are written to files (labels of returns): add new ones at the end only.
enum class ObjectKind : std::uint8_t {
    Ground = 0,  ///< what vehicles and people move on; the level part of kerbs and sidewalks too
    Noise,       ///< no thing at all: rain, dust
    // Class Vehicle.
    Car,
    Van,
    Truck,
    Bus,
    Tram,
    Trailer,
    Tractor,
    Motorcycle,  ///< parked; with its rider it is a Motorcyclist
    // Class Cyclist: whoever rides.
    Cyclist,
    Motorcyclist,
    ScooterRider,  ///< on a kick scooter
    ChairUser,     ///< in a powered chair
    // Class Pedestrian: on foot, standing or sitting, with the pram or trolley that is pushed.
    Pedestrian,
    // Class Unknown: compact, and no road user of its own.
    Bicycle,  ///< parked
    Scooter,  ///< parked
    Bin,
    Bollard,
    Animal,
    // Class Structure.
    Wall,
    Fence,
    Hedge,
    Bush,
    Tree,
    Pole,
    Sign,
    Rail,
    Kerb,
    Step,      ///< steps and stairs
    Ramp,      ///< speed bumps, ramps of loading bays
    Overhead,  ///< what one drives under: bridges
    Scaffold,
    Furniture,  ///< benches, tables, kiosks, shelters
    Crate,      ///< crates and pallets of goods
    Pile,       ///< heaps of earth, gravel, leaves
};

/// Its name in truth files: "car", "pedestrian", "hedge" ...
const char* nameOf(ObjectKind kind);

/// The kind of that name in small letters, also by the other names that sets of labels use ("sedan", "person_sitting");
/// none if there is no such kind.
std::optional<ObjectKind> kindNamed(const std::string& name);

/// The class that a detector should give it. Ground and noise are nothing that stands: Unknown.
ObstacleClass classOf(ObjectKind kind);

/// Between these heights the body of a vehicle fills its box: beams go through below it and through its windows [m].
constexpr double kVehicleBelly = 0.3;
constexpr double kVehicleWindows = 0.8;

/// No vehicle is lower [m].
constexpr double kLeastVehicleHeight = 0.6;

/// How large a thing of a class can be, seen from above and in height [m].
struct SizeLimits {
    float max_length;
    float max_width;
    float min_height;  ///< of its top
    float max_height;
};
/// The limits of a road user's class: a person with the pram or trolley that is pushed, a rider with the vehicle, a
/// kick scooter to an articulated bus. Without limits for Structure and Unknown.
SizeLimits sizeLimitsOf(ObstacleClass cls, float top);

/// All kinds in the order of their values.
const std::vector<ObjectKind>& allKinds();

}  // namespace lidar_obstacles
