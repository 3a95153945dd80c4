// SPDX-License-Identifier: BSD-3-Clause
#include "scene_layouts.h"

#include <algorithm>
#include <cmath>

#include "scene_choices.h"

namespace lidar_obstacles::simulation {
namespace {

/// Everything from end to end of the track between two d, or the mirror image of that.
Zone along(const SceneDraft& draft, double low, double high) { return {3.0, draft.length() - 3.0, low, high}; }

/// About where the vehicle is.
Zone near(const SceneDraft& draft, double ahead, double low, double high) {
    const double s = draft.egoStart().s;
    return {s - 0.6 * ahead, s + ahead, low, high};
}

/// Who and what is met at close range wherever one drives; called before the rest takes the room.
void layCompany(SceneDraft& draft) {
    const double d = draft.egoStart().d;
    const Zone close = near(draft, 18.0, d - 10.0, d + 10.0);
    strewRiders(draft, close, draft.count(1, 5));
    strewAnimals(draft, close, draft.count(0, 2));
    strewPeople(draft, close, draft.count(2, 7));
    strewLoneThings(draft, close, draft.count(2, 8));
    strewFurniture(draft, close, draft.count(2, 8));
}

/// Vehicles on their way, in the right or, against the track, in the left lane.
void driveAlong(SceneDraft& draft, int number, double fastest) {
    for (int i = 0; i < number; ++i) {
        const bool oncoming = draft.chance(0.5), waits = draft.chance(0.25);
        const double lane = std::min(0.5 * draft.halfWidth(), 2.6) + draft.uniform(-0.3, 0.3);
        const std::string model = anyTrafficVehicle(draft);
        for (int trial = 0; trial < 5; ++trial) {
            const double s = draft.uniform(5.0, draft.length() - 5.0);
            const Spot spot{s, oncoming ? lane : -lane, oncoming ? M_PI : 0.0};
            if (waits ? draft.stand(model, spot) : draft.moveOn(model, spot, draft.uniform(1.0, fastest))) break;
        }
    }
}

/// Who drives ahead, behind and beside the vehicle, about as fast: what is seen most on any road.
void layConvoy(SceneDraft& draft) {
    const Waypoint ego = draft.egoStart();
    struct Place {
        double share;        ///< how often somebody is there
        double least, most;  ///< distance of the middles along the road [m]
        double sign;
        double beside;  ///< of the lane from ours [m]
    };
    const double next_lane = ego.d < 0.0 ? 3.3 : -3.3;
    for (const Place& place : {Place{0.75, 6.0, 32.0, 1.0, 0.0}, Place{0.5, 6.0, 32.0, -1.0, 0.0},
                               Place{0.3, 0.5, 20.0, 1.0, next_lane}, Place{0.3, 0.5, 20.0, -1.0, next_lane}}) {
        if (!draft.chance(place.share)) continue;
        const std::string model = anyTrafficVehicle(draft);
        for (int trial = 0; trial < 5; ++trial) {
            const double away = place.sign * draft.logUniform(place.least, place.most);
            const Spot spot{ego.s + away, ego.d + place.beside + draft.uniform(-0.4, 0.4), 0.0};
            if (draft.moveOn(model, spot, std::max(0.01, draft.egoSpeed() + draft.uniform(-1.5, 1.5)))) break;
        }
    }
}

/// Kerbs, raised sidewalks, and at times a speed bump.
void layKerbs(SceneDraft& draft, double sidewalk) {
    const double height = draft.uniform(0.06, 0.16);
    for (double side : {-1.0, 1.0}) {
        ClutterSpec walk;
        walk.kind = draft.chance(0.7) ? ClutterKind::Sidewalk : ClutterKind::Kerb;
        walk.from = 0.0, walk.to = draft.length();
        walk.width = walk.kind == ClutterKind::Sidewalk ? sidewalk : 0.3;
        walk.height = height;
        walk.d = side * (draft.halfWidth() + 0.5 * walk.width);
        draft.put(walk);
    }
    if (!draft.chance(0.25)) return;
    ClutterSpec bump;
    bump.kind = ClutterKind::Ramp;
    bump.from = draft.uniform(10.0, draft.length() - 10.0);
    bump.length = draft.uniform(1.0, 4.0), bump.width = 2.0 * draft.halfWidth(),
    bump.height = draft.uniform(0.06, 0.14);
    draft.put(bump);
}

/// Houses, gardens and trees beside a street whose sidewalks are so wide.
void layFronts(SceneDraft& draft, double sidewalk) {
    const double edge = draft.halfWidth() + sidewalk, far = draft.reach();
    for (double side : {-1.0, 1.0}) {
        const double low = std::min(side * edge, side * far), high = std::max(side * edge, side * far);
        if (draft.chance(0.85)) putBoundary(draft, side * (edge + 0.2), draft.uniform(0.2, 6.0));
        const double kerb = side * draft.halfWidth();
        // Beside the kerb: their crowns reach over what is parked.
        strewTrees(draft, along(draft, std::min(kerb, side * edge), std::max(kerb, side * edge)), draft.count(0, 10));
        strewTrees(draft, along(draft, low, high), draft.count(2, 10));
        strewLoneThings(draft, along(draft, low, high), draft.count(4, 16));
        strewVehicles(draft, along(draft, low, high), draft.count(0, 5));
    }
}

void parkBothSides(SceneDraft& draft, double edge) {
    for (double side : {-1.0, 1.0}) {
        if (draft.chance(0.25)) continue;
        const double u = draft.uniform(0.0, 1.0);
        const double yaw = u < 0.65 ? 0.0 : u < 0.85 ? 0.5 * M_PI : draft.uniform(0.7, 1.2);
        const double deep = yaw == 0.0 ? 1.1 : 2.5;
        parkRow(draft, {2.0, draft.length() - 2.0, side * (edge - deep), yaw, draft.uniform(0.2, 0.9)});
    }
}

/// What is on and beside a street; people and riders so many.
void layTown(SceneDraft& draft, int people, int riders) {
    const double sidewalk = draft.uniform(1.5, 4.5), half = draft.halfWidth();
    layKerbs(draft, sidewalk);
    parkBothSides(draft, half);
    driveAlong(draft, draft.count(2, 9), 14.0);
    layCompany(draft);
    strewRiders(draft, along(draft, -half - sidewalk, half + sidewalk), riders);
    layFronts(draft, sidewalk);
    strewFurniture(draft, along(draft, half, half + sidewalk), draft.count(6, 30));
    strewFurniture(draft, along(draft, -half - sidewalk, -half), draft.count(6, 30));
    strewPeople(draft, along(draft, half, half + sidewalk), people / 2);
    strewPeople(draft, along(draft, -half - sidewalk, -half), people / 2);
    strewPeople(draft, along(draft, -half, half), draft.count(0, 4));
    strewPeople(draft, near(draft, 20.0, -half - sidewalk, half + sidewalk), draft.count(1, 6));
    strewAnimals(draft, along(draft, -half - sidewalk, half + sidewalk), draft.count(0, 2));
}

}  // namespace

void layStreet(SceneDraft& draft) {
    layConvoy(draft);
    layTown(draft, draft.count(6, 22), draft.count(2, 8));
}

void laySidewalk(SceneDraft& draft) {
    layTown(draft, draft.count(14, 30), draft.count(3, 9));
    const double d = draft.egoStart().d;
    strewPeople(draft, near(draft, 12.0, d - 3.0, d + 3.0), draft.count(4, 12));
}

void layCarPark(SceneDraft& draft) {
    const double far = draft.reach(), aisle = draft.uniform(5.5, 8.0), pitch = aisle + 10.4;
    const double yaw = draft.chance(0.6) ? 0.5 * M_PI : draft.uniform(0.8, 1.3);
    const double occupied = draft.uniform(0.15, 0.9);
    layCompany(draft);
    for (double d = 0.5 * aisle + 2.6; d < far - 3.0; d += pitch)
        for (double side : {-1.0, 1.0}) {
            parkRow(draft, {4.0, draft.length() - 4.0, side * d, yaw, occupied});
            if (d + 5.2 < far - 3.0) parkRow(draft, {4.0, draft.length() - 4.0, side * (d + 5.2), yaw, occupied});
        }
    const Zone all = along(draft, -far, far), close = near(draft, 25.0, -15.0, 15.0);
    for (double side : {-1.0, 1.0})
        if (draft.chance(0.7)) putBoundary(draft, side * (far - 4.0), 2.0);
    strewVehicles(draft, all, draft.count(2, 10));
    strewLoneThings(draft, all, draft.count(8, 24));
    strewLoneThings(draft, close, draft.count(2, 8));
    driveAlong(draft, draft.count(0, 3), 5.0);
    strewFurniture(draft, all, draft.count(5, 20));
    strewPeople(draft, all, draft.count(4, 14));
    strewPeople(draft, close, draft.count(3, 12));
    strewRiders(draft, all, draft.count(0, 4));
    strewAnimals(draft, all, draft.count(0, 1));
}

void layForestRoad(SceneDraft& draft) {
    const double half = draft.halfWidth(), far = draft.reach();
    layConvoy(draft);
    layCompany(draft);
    driveAlong(draft, draft.count(0, 3), 12.0);
    strewRiders(draft, along(draft, -half, half), draft.count(0, 4));
    strewPeople(draft, near(draft, 25.0, -half - 2.0, half + 2.0), draft.count(1, 6));
    strewAnimals(draft, near(draft, 25.0, -half - 2.0, half + 2.0), draft.count(0, 3));
    for (double side : {-1.0, 1.0}) {
        const double first = half + draft.uniform(0.5, 4.0);
        const double low = std::min(side * first, side * far), high = std::max(side * first, side * far);
        const double middle = side * (first + 8.0);
        parkRow(draft, {5.0, draft.length() - 5.0, side * (half + 1.3), 0.0, draft.uniform(0.0, 0.15)});
        if (draft.chance(0.3)) putBoundary(draft, side * (half + 0.8), 1.0);
        strewVehicles(draft, along(draft, low, high), draft.count(0, 3));
        strewTrees(draft, along(draft, low, high), draft.count(30, 70));
        strewLoneThings(draft, along(draft, std::min(side * first, middle), std::max(side * first, middle)),
                        draft.count(10, 30));
        strewPeople(draft, along(draft, low, high), draft.count(0, 3));
    }
    strewFurniture(draft, along(draft, -half - 3.0, half + 3.0), draft.count(0, 5));
}

void layTrack(SceneDraft& draft) {
    const double half = draft.halfWidth(), far = draft.reach();
    if (draft.chance(0.2)) {
        ClutterSpec bridge;
        bridge.kind = ClutterKind::Bridge;
        bridge.from = draft.uniform(20.0, draft.length() - 20.0);
        bridge.length = 2.0 * half + 8.0, bridge.width = draft.uniform(3.0, 10.0);
        bridge.height = draft.uniform(4.6, 6.0);
        draft.put(bridge);
    }
    layConvoy(draft);
    layCompany(draft);
    driveAlong(draft, draft.count(1, 6), 28.0);
    for (double side : {-1.0, 1.0}) {
        const double edge = half + draft.uniform(1.0, 10.0);
        ClutterSpec rail;
        rail.kind = draft.chance(0.6) ? ClutterKind::Rail : draft.chance(0.5) ? ClutterKind::Wall : ClutterKind::Fence;
        rail.from = draft.uniform(-10.0, 30.0), rail.to = draft.length() - draft.uniform(-10.0, 30.0);
        rail.d = side * edge, rail.width = 0.15, rail.height = draft.uniform(0.7, 1.2);
        if (draft.chance(0.8)) draft.put(rail);
        const double low = std::min(side * half, side * far), high = std::max(side * half, side * far);
        if (draft.chance(0.4)) putBoundary(draft, side * (edge + 1.0), 8.0);
        strewVehicles(draft, along(draft, low, high), draft.count(1, 6));
        strewLoneThings(draft, along(draft, low, high), draft.count(5, 20));
        strewTrees(draft, along(draft, std::min(side * edge, side * far), std::max(side * edge, side * far)),
                   draft.count(5, 35));
        strewFurniture(draft, along(draft, low, high), draft.count(2, 8));
        strewPeople(draft, along(draft, low, high), draft.count(1, 6));
    }
}

void layPark(SceneDraft& draft) {
    const double far = draft.reach();
    const Zone all = along(draft, -far, far), close = near(draft, 20.0, -14.0, 14.0);
    layCompany(draft);
    for (double side : {-1.0, 1.0})
        if (draft.chance(0.6)) putBoundary(draft, side * draft.uniform(8.0, far - 4.0), 4.0);
    strewVehicles(draft, all, draft.count(4, 14));
    strewVehicles(draft, close, draft.count(1, 5));
    strewLoneThings(draft, all, draft.count(20, 50));
    strewLoneThings(draft, close, draft.count(4, 12));
    strewTrees(draft, all, draft.count(6, 30));
    strewFurniture(draft, all, draft.count(6, 18));
    strewPeople(draft, all, draft.count(4, 12));
    strewPeople(draft, close, draft.count(4, 12));
    strewRiders(draft, all, draft.count(2, 6));
    strewAnimals(draft, close, draft.count(0, 3));
}

void layOpenRoad(SceneDraft& draft) {
    const double half = draft.halfWidth(), far = draft.reach(), d = draft.egoStart().d;
    const Zone about = near(draft, 30.0, d - 15.0, d + 15.0);
    layConvoy(draft);
    driveAlong(draft, draft.count(0, 3), 25.0);
    strewVehicles(draft, about, draft.count(0, 2));
    strewRiders(draft, about, draft.count(0, 2));
    strewPeople(draft, about, draft.count(0, 3));
    strewLoneThings(draft, about, draft.count(0, 4));
    strewFurniture(draft, about, draft.count(0, 3));
    for (double side : {-1.0, 1.0}) {
        const double edge = half + draft.uniform(2.0, 15.0);
        const double low = std::min(side * edge, side * far), high = std::max(side * edge, side * far);
        if (draft.chance(0.3)) putBoundary(draft, side * edge, 6.0);
        strewTrees(draft, along(draft, low, high), draft.count(0, 8));
        strewLoneThings(draft, along(draft, low, high), draft.count(0, 6));
    }
}

}  // namespace lidar_obstacles::simulation
