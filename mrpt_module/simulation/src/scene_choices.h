// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is drawn into random scenes, and how often: vehicles, people, riders, plants, goods, furniture, boundaries.
#pragma once

#include "scene_draft.h"

namespace lidar_obstacles::simulation {

std::string anyVehicle(SceneDraft& draft);
std::string anyTrafficVehicle(SceneDraft& draft);  ///< that one meets on the move
std::string anyStander(SceneDraft& draft);         ///< a person who stays where he or she is
std::string anyWalker(SceneDraft& draft);
std::string anyRider(SceneDraft& draft);

/// Plants; `leaves` and `roughness` are drawn for each.
ClutterSpec anyPlant(SceneDraft& draft, ClutterKind kind);
/// A thing of half a metre to a car's size that stands alone: bush, shrub, tree, pile, crates, skip ...
ClutterSpec anyLoneThing(SceneDraft& draft);
ClutterSpec anyFurniture(SceneDraft& draft);
ClutterSpec at(ClutterSpec spec, const Spot& spot);

// Each tries so many things in a zone; what finds no room is left out.
void strewLoneThings(SceneDraft& draft, const Zone& zone, int number);
void strewFurniture(SceneDraft& draft, const Zone& zone, int number);
void strewTrees(SceneDraft& draft, const Zone& zone, int number);
void strewVehicles(SceneDraft& draft, const Zone& zone, int number);  ///< parked at any yaw
/// Alone, in groups, beside things, standing or on their way.
void strewPeople(SceneDraft& draft, const Zone& zone, int number);
void strewRiders(SceneDraft& draft, const Zone& zone, int number);
void strewAnimals(SceneDraft& draft, const Zone& zone, int number);
/// A row of parked things; in some places another thing, or nothing. Their yaw differs by a few degrees.
struct ParkingRow {
    double from, to, d, yaw, occupied;  ///< yaw from the track's direction; share of the places taken
};
void parkRow(SceneDraft& draft, const ParkingRow& row);
/// Walls, houses, fences, hedges, rails, scaffolds and gaps along the track at d, about `depth` deep to the outside.
void putBoundary(SceneDraft& draft, double d, double depth);

}  // namespace lidar_obstacles::simulation
