// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scene_choices.h"

namespace lidar_obstacles::simulation {
namespace {

void strewGroup(SceneDraft& draft, const Spot& middle) {
    const int n = draft.count(2, 6);
    const bool walking = draft.chance(0.4);
    const double heading = middle.yaw, speed = draft.uniform(0.5, 1.6), radius = draft.uniform(0.35, 0.35 + 0.12 * n);
    for (int k = 0; k < n; ++k) {
        const double angle = 2.0 * M_PI * k / n + draft.uniform(-0.2, 0.2);
        const Spot spot{middle.s + radius * std::cos(angle), middle.d + radius * std::sin(angle),
                        walking ? heading : angle + M_PI};
        if (walking)
            draft.moveOn(anyWalker(draft), spot, speed);
        else
            draft.stand(draft.chance(0.7) ? "standing_pedestrian" : anyStander(draft), spot);
    }
}

void strewPerson(SceneDraft& draft, const Zone& zone) {
    const Spot spot = draft.chance(0.35) ? draft.spotBeside() : draft.spotIn(zone);
    if (draft.chance(0.5)) {
        draft.stand(anyStander(draft), spot);
        return;
    }
    draft.moveOn(anyWalker(draft), spot, draft.uniform(0.4, 2.2));
}

/// A house, perhaps with a scaffold before it. `out` is +1 on the left side.
void putHouse(SceneDraft& draft, const Zone& zone, double out) {
    const double depth = draft.uniform(5.0, 12.0);
    const bool scaffold = draft.chance(0.15);
    ClutterSpec house;
    house.kind = ClutterKind::Building;
    house.from = 0.5 * (zone.from + zone.to);
    house.length = zone.to - zone.from, house.width = depth, house.height = draft.uniform(2.8, 12.0);
    house.d = zone.low + out * (0.5 * depth + (scaffold ? 1.6 : 0.0));
    if (!draft.put(house) || !scaffold) return;
    ClutterSpec before = house;
    before.kind = ClutterKind::Scaffold;
    before.d = zone.low + out * 0.8, before.width = 1.0, before.yaw = out > 0.0 ? M_PI : 0.0;
    draft.put(before);
}

ClutterSpec lineOf(ClutterKind kind, double width, double height) {
    ClutterSpec spec;
    spec.kind = kind, spec.width = width, spec.height = height;
    return spec;
}

/// A wall, fence, hedge or rail, or a wall or fence with openings.
void putLine(SceneDraft& draft, const Zone& zone, double out) {
    ClutterSpec spec;
    const double u = draft.uniform(0.0, 1.0);
    if (u < 0.22)
        spec = lineOf(ClutterKind::Wall, draft.uniform(0.2, 0.5), draft.uniform(0.5, 2.6));
    else if (u < 0.40)
        spec = lineOf(ClutterKind::Fence, 0.06, draft.uniform(0.9, 2.2));
    else if (u < 0.76)
        spec = anyPlant(draft, ClutterKind::Hedge);
    else if (u < 0.86)
        spec = lineOf(ClutterKind::Rail, 0.12, draft.uniform(0.6, 0.8));
    else if (u < 0.93)
        spec = lineOf(ClutterKind::OpenWall, 0.25, draft.uniform(1.0, 2.8));
    else
        spec = lineOf(ClutterKind::Panel, 0.08, draft.uniform(0.9, 2.2));
    const bool line = spec.kind != ClutterKind::OpenWall && spec.kind != ClutterKind::Panel;
    spec.from = line ? zone.from : 0.5 * (zone.from + zone.to);
    spec.to = zone.to;
    spec.length = line ? 0.0 : zone.to - zone.from;
    spec.d = zone.low + out * 0.6 * spec.width;
    draft.put(spec);
}

}  // namespace

void strewLoneThings(SceneDraft& draft, const Zone& zone, int number) {
    for (int i = 0; i < number; ++i)
        draft.put(at(anyLoneThing(draft), draft.chance(0.2) ? draft.spotBeside() : draft.spotIn(zone)));
}

void strewFurniture(SceneDraft& draft, const Zone& zone, int number) {
    for (int i = 0; i < number; ++i) {
        const ClutterSpec thing = anyFurniture(draft);
        const Spot spot = draft.spotIn(zone);
        const bool row = thing.kind == ClutterKind::Bike || thing.kind == ClutterKind::Bollard ||
                         thing.kind == ClutterKind::Scooter || thing.kind == ClutterKind::Cone ||
                         thing.kind == ClutterKind::Barrier;
        const int n = row ? draft.count(1, 10) : 1;
        const double step =
            (thing.kind == ClutterKind::Barrier ? thing.length : thing.width) + draft.uniform(0.15, 1.2);
        const bool along = thing.kind == ClutterKind::Barrier;
        for (int k = 0; k < n; ++k) {
            const double across = spot.yaw + (along ? 0.0 : 0.5 * M_PI);
            draft.put(
                at(thing, {spot.s + k * step * std::cos(across), spot.d + k * step * std::sin(across), spot.yaw}));
        }
    }
}

void strewTrees(SceneDraft& draft, const Zone& zone, int number) {
    for (int i = 0; i < number; ++i) draft.put(at(anyPlant(draft, ClutterKind::Tree), draft.spotIn(zone)));
}

void strewVehicles(SceneDraft& draft, const Zone& zone, int number) {
    for (int i = 0; i < number; ++i) draft.stand(anyVehicle(draft), draft.spotIn(zone));
}

void strewPeople(SceneDraft& draft, const Zone& zone, int number) {
    for (int i = 0; i < number; ++i) {
        if (draft.chance(0.2))
            strewGroup(draft, draft.spotIn(zone));
        else
            strewPerson(draft, zone);
    }
}

void strewRiders(SceneDraft& draft, const Zone& zone, int number) {
    for (int i = 0; i < number; ++i) {
        const std::string model = anyRider(draft);
        const double fastest = model == "chair_user" ? 2.5 : model == "motorcyclist" ? 14.0 : 7.0;
        if (draft.chance(0.2)) {  // waits
            draft.stand(model, draft.spotIn(zone));
            continue;
        }
        // The way takes much room: looked for several times.
        for (int trial = 0; trial < 6; ++trial)
            if (draft.moveOn(model, draft.spotIn(zone), draft.logUniform(0.7, fastest))) break;
    }
}

void strewAnimals(SceneDraft& draft, const Zone& zone, int number) {
    for (int i = 0; i < number; ++i) draft.moveOn("dog", draft.spotIn(zone), draft.uniform(0.3, 2.5));
}

void parkRow(SceneDraft& draft, const ParkingRow& row) {
    const double across = std::abs(std::sin(row.yaw)), step = 2.6 / std::max(0.42, across) + draft.uniform(0.0, 0.6);
    for (double s = row.from; s < row.to; s += step) {
        if (!draft.chance(row.occupied)) continue;
        const bool backwards = draft.chance(0.5);
        const Spot spot{s + draft.uniform(-0.25, 0.25), row.d + draft.uniform(-0.25, 0.25),
                        row.yaw + (backwards ? M_PI : 0.0) + draft.uniform(-0.08, 0.08)};
        if (draft.chance(0.12))
            draft.put(at(anyLoneThing(draft), spot));
        else
            draft.stand(anyVehicle(draft), spot);
    }
}

void putBoundary(SceneDraft& draft, double d, double depth) {
    const double out = d > 0.0 ? 1.0 : -1.0;
    for (double s = draft.uniform(-5.0, 5.0); s < draft.length();) {
        const double length = draft.uniform(5.0, 22.0), inner = d + out * draft.uniform(0.0, depth);
        const Zone piece{s, s + length, inner, inner};
        const double u = draft.uniform(0.0, 1.0);
        if (u < 0.36)
            putHouse(draft, piece, out);
        else if (u < 0.90)
            putLine(draft, piece, out);
        s += length + (draft.chance(0.3) ? draft.uniform(0.5, 6.0) : 0.3);
    }
}

}  // namespace lidar_obstacles::simulation
