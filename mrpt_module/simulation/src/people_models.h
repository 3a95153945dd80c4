// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// People on foot, and whoever rides.
#pragma once

#include <string>

#include "figure.h"
#include "lidar_obstacles/simulation/models.h"

namespace lidar_obstacles::simulation {

/// A person of that height [m], standing or in eight steps of a walk. The box is the smallest that holds them all.
struct Person {
    std::string name;
    double height;
    bool walking;
    Figure figure = {};
};
Model personModel(const Person& person, std::uint64_t variant);

/// Persons that walk with a thing before or behind them, which belongs to their box.
Model pramPusherModel(std::uint64_t variant);
Model trolleyPusherModel(std::uint64_t variant);
Model wheelchairPusherModel(std::uint64_t variant);
Model suitcasePullerModel(std::uint64_t variant);
/// Sits on a chair.
Model sitterModel(std::uint64_t variant);
/// A dog that walks.
Model dogModel(std::uint64_t variant);

/// A person on a bicycle.
Model cyclistModel(std::uint64_t variant);
Model motorcycleModel(std::uint64_t variant);
Model motorcyclistModel(std::uint64_t variant);
/// Stands on a kick scooter.
Model scooterRiderModel(std::uint64_t variant);
/// Sits in a powered chair.
Model chairUserModel(std::uint64_t variant);

}  // namespace lidar_obstacles::simulation
