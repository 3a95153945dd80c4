// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How the kinds of random scenes are laid out. Each fills a draft whose track, terrain and vehicle are there.
#pragma once

#include "scene_draft.h"

namespace lidar_obstacles::simulation {

void layStreet(SceneDraft& draft);
void layCarPark(SceneDraft& draft);
void laySidewalk(SceneDraft& draft);
void layForestRoad(SceneDraft& draft);
void layTrack(SceneDraft& draft);
void layPark(SceneDraft& draft);
void layOpenRoad(SceneDraft& draft);

}  // namespace lidar_obstacles::simulation
