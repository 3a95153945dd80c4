// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/models.h"

#include <functional>
#include <map>

#include "people_models.h"
#include "vehicle_shape.h"

namespace lidar_obstacles::simulation {
namespace {

using Maker = std::function<Model(std::uint64_t variant)>;

Figure bending() {
    Figure figure;
    figure.lean = 1.1, figure.reach = 0.3;
    return figure;
}

Figure crouching() {
    Figure figure;
    figure.sit = 1.9, figure.shin = -0.75, figure.hip_height = 0.17, figure.lean = 0.35, figure.reach = 0.9;
    return figure;
}

void addPeople(std::map<std::string, Maker>& all) {
    const auto person = [&all](const Person& p) { all[p.name] = [p](std::uint64_t v) { return personModel(p, v); }; };
    person({"pedestrian", 1.76, true});
    person({"tall_pedestrian", 1.88, true});
    person({"child", 1.20, true});
    person({"standing_pedestrian", 1.72, false});
    person({"bending_pedestrian", 1.72, false, bending()});
    person({"crouching_pedestrian", 1.74, false, crouching()});
    all["sitting_pedestrian"] = sitterModel;
    all["pram_pusher"] = pramPusherModel;
    all["trolley_pusher"] = trolleyPusherModel;
    all["wheelchair_pusher"] = wheelchairPusherModel;
    all["suitcase_puller"] = suitcasePullerModel;
}

std::map<std::string, Maker> makeMakers() {
    std::map<std::string, Maker> all;
    for (const VehicleShape& shape : vehicleShapes())
        all[shape.name] = [&shape](std::uint64_t v) { return vehicleModel(varied(shape, v)); };
    all["articulated_bus"] = articulatedBusModel;
    all["tractor"] = tractorModel;
    all["motorcycle"] = motorcycleModel;
    all["cyclist"] = cyclistModel;
    all["motorcyclist"] = motorcyclistModel;
    all["scooter_rider"] = scooterRiderModel;
    all["chair_user"] = chairUserModel;
    all["dog"] = dogModel;
    addPeople(all);
    return all;
}

const std::map<std::string, Maker>& makers() {
    static const std::map<std::string, Maker> all = makeMakers();
    return all;
}

}  // namespace

std::vector<std::string> modelNames() {
    std::vector<std::string> names;
    for (const auto& [name, maker] : makers()) names.push_back(name);
    return names;
}

std::shared_ptr<const Model> modelNamed(const std::string& name, std::uint64_t variant) {
    const auto it = makers().find(name);
    return it == makers().end() ? nullptr : std::make_shared<const Model>(it->second(variant));
}

}  // namespace lidar_obstacles::simulation
