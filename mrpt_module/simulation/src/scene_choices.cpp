// SPDX-License-Identifier: BSD-3-Clause
#include "scene_choices.h"

#include <cmath>

namespace lidar_obstacles::simulation {

std::string anyVehicle(SceneDraft& draft) {
    static const Choices choices{
        {"sedan", 14},     {"hatchback", 14},      {"suv", 13},         {"estate", 10},
        {"small_car", 11}, {"coupe", 4},           {"minivan", 6},      {"van", 9},
        {"pickup", 4},     {"box_truck", 3},       {"truck", 2},        {"minibus", 2},
        {"bus", 2},        {"articulated_bus", 1}, {"semi_trailer", 1}, {"truck_and_trailer", 1},
        {"dump_truck", 1}, {"trailer", 2},         {"caravan", 2},      {"tractor", 1.5},
        {"motorcycle", 6}, {"tram", 0.5}};
    return draft.choose(choices);
}

std::string anyTrafficVehicle(SceneDraft& draft) {
    static const Choices choices{{"sedan", 14},
                                 {"hatchback", 14},
                                 {"suv", 13},
                                 {"estate", 9},
                                 {"small_car", 10},
                                 {"coupe", 4},
                                 {"minivan", 6},
                                 {"van", 9},
                                 {"pickup", 4},
                                 {"box_truck", 4},
                                 {"truck", 3},
                                 {"minibus", 2},
                                 {"bus", 4},
                                 {"tram", 1},
                                 {"articulated_bus", 2},
                                 {"semi_trailer", 2},
                                 {"dump_truck", 2},
                                 {"tractor", 2},
                                 {"truck_and_trailer", 1}};
    return draft.choose(choices);
}

std::string anyStander(SceneDraft& draft) {
    static const Choices choices{{"standing_pedestrian", 12},
                                 {"bending_pedestrian", 3},
                                 {"crouching_pedestrian", 3},
                                 {"sitting_pedestrian", 4},
                                 {"child", 3},
                                 {"trolley_pusher", 1.5},
                                 {"pram_pusher", 1.5},
                                 {"suitcase_puller", 1},
                                 {"wheelchair_pusher", 1}};
    return draft.choose(choices);
}

std::string anyWalker(SceneDraft& draft) {
    static const Choices choices{{"pedestrian", 12},      {"tall_pedestrian", 6}, {"child", 5},
                                 {"pram_pusher", 2},      {"trolley_pusher", 2},  {"suitcase_puller", 2},
                                 {"wheelchair_pusher", 1}};
    return draft.choose(choices);
}

std::string anyRider(SceneDraft& draft) {
    static const Choices choices{{"cyclist", 8}, {"motorcyclist", 3}, {"scooter_rider", 3}, {"chair_user", 3}};
    return draft.choose(choices);
}

ClutterSpec at(ClutterSpec spec, const Spot& spot) {
    spec.from = spot.s;
    spec.d = spot.d;
    spec.yaw = spot.yaw;
    return spec;
}

ClutterSpec anyPlant(SceneDraft& draft, ClutterKind kind) {
    ClutterSpec plant;
    plant.kind = kind;
    const auto draw = [&](double leaves_low, double leaves_high, double rough) {
        plant.leaves = draft.logUniform(leaves_low, leaves_high);
        plant.roughness = rough * draft.logUniform(0.5, 2.0);
    };
    if (kind == ClutterKind::Tree) {
        plant.height = draft.uniform(2.5, 11.0);
        plant.width = plant.height * draft.uniform(0.3, 0.75);
        draw(0.08, 1.2, 0.15);
    } else if (kind == ClutterKind::Bush) {
        plant.width = draft.logUniform(0.5, 3.5);
        plant.length = plant.width * draft.uniform(0.8, 1.6);
        plant.height = std::min(3.0, plant.width * draft.uniform(0.5, 1.2));
        draw(0.012, 0.18, 0.05);
    } else if (kind == ClutterKind::Reed) {
        plant.width = draft.uniform(0.4, 1.5);
        plant.length = plant.width;
        plant.height = draft.uniform(0.5, 1.8);
        draw(0.08, 0.6, 0.08);
    } else {  // cut
        plant.width = draft.uniform(0.5, 2.0);
        plant.length = plant.width * draft.uniform(1.0, 3.0);
        plant.height = draft.uniform(0.4, 2.3);
        const bool well_kept = draft.chance(0.75);
        draw(0.01, well_kept ? 0.06 : 0.12, well_kept ? 0.02 : 0.05);
    }
    return plant;
}

namespace {

/// Of any size between that of a stool and that of a car.
ClutterSpec anyGoods(SceneDraft& draft) {
    ClutterSpec thing;
    const double u = draft.uniform(0.0, 1.0);
    thing.kind = u < 0.4 ? ClutterKind::Crate : u < 0.75 ? ClutterKind::Pile : ClutterKind::Skip;
    thing.length = draft.logUniform(0.6, 4.5);
    thing.width = std::max(0.4, thing.length * draft.uniform(0.4, 1.0));
    thing.height = std::min(2.2, thing.length * draft.uniform(0.3, 1.0) + 0.2);
    if (thing.kind == ClutterKind::Skip) thing.length += 1.0, thing.height = draft.uniform(1.0, 2.2);
    thing.roughness = draft.logUniform(0.01, 0.08);
    return thing;
}

struct Sized {
    ClutterKind kind;
    double length, width, height;
};

}  // namespace

ClutterSpec anyLoneThing(SceneDraft& draft) {
    const double u = draft.uniform(0.0, 1.0);
    if (u < 0.34) return anyPlant(draft, ClutterKind::Bush);
    if (u < 0.58) return anyPlant(draft, ClutterKind::Shrub);
    if (u < 0.66) return anyPlant(draft, ClutterKind::Reed);
    if (u < 0.80) return anyPlant(draft, ClutterKind::Tree);
    return anyGoods(draft);
}

ClutterSpec anyFurniture(SceneDraft& draft) {
    struct Choice {
        Sized thing;
        double share;  ///< how often it is met in towns, about
    };
    static const Choice choices[] = {
        {{ClutterKind::Bench, 1.8, 0.55, 0.85}, 2.0},   {{ClutterKind::Table, 1.8, 1.7, 0.75}, 1.0},
        {{ClutterKind::Kiosk, 3.0, 2.5, 2.6}, 0.6},     {{ClutterKind::Shelter, 4.0, 1.5, 2.5}, 1.0},
        {{ClutterKind::Cabinet, 0.8, 0.6, 1.3}, 2.0},   {{ClutterKind::Planter, 1.3, 0.9, 1.1}, 1.5},
        {{ClutterKind::Bin, 0.6, 0.6, 1.1}, 3.0},       {{ClutterKind::Bin, 1.3, 1.0, 1.4}, 2.0},
        {{ClutterKind::Sign, 0.0, 0.6, 2.6}, 3.0},      {{ClutterKind::Board, 0.0, 2.0, 2.5}, 0.6},
        {{ClutterKind::Lamp, 0.0, 0.14, 6.0}, 3.0},     {{ClutterKind::Pole, 0.0, 0.2, 7.0}, 3.0},
        {{ClutterKind::Bollard, 0.0, 0.2, 0.9}, 3.0},   {{ClutterKind::Bollard, 0.0, 0.5, 0.6}, 1.0},
        {{ClutterKind::Bike, 1.75, 0.5, 1.05}, 4.0},    {{ClutterKind::Scooter, 1.1, 0.45, 1.1}, 1.5},
        {{ClutterKind::Carts, 2.5, 0.6, 1.0}, 0.5},     {{ClutterKind::Cone, 0.0, 0.36, 0.7}, 1.0},
        {{ClutterKind::Barrier, 3.0, 0.6, 0.85}, 1.0},  {{ClutterKind::Stairs, 2.0, 2.0, 1.0}, 0.6},
        {{ClutterKind::OpenWall, 7.0, 0.25, 2.4}, 0.6}, {{ClutterKind::Panel, 5.0, 0.08, 1.3}, 0.6},
        {{ClutterKind::Scaffold, 7.5, 1.0, 6.0}, 0.5},  {{ClutterKind::Step, 1.2, 0.5, 0.4}, 0.6}};
    double sum = 0.0;
    for (const Choice& c : choices) sum += c.share;
    double left = draft.uniform(0.0, sum);
    const Choice* choice = std::begin(choices);
    while (choice + 1 != std::end(choices) && (left -= choice->share) >= 0.0) ++choice;
    const Sized& drawn = choice->thing;
    ClutterSpec spec;
    spec.kind = drawn.kind;
    spec.length = drawn.length * draft.uniform(0.75, 1.35);
    spec.width = drawn.width * draft.uniform(0.8, 1.25);
    spec.height = drawn.height * draft.uniform(0.85, 1.2);
    spec.leaves = drawn.kind == ClutterKind::Planter ? draft.logUniform(0.015, 0.1) : 0.0;
    return spec;
}

}  // namespace lidar_obstacles::simulation
