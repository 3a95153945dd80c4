// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The panel that only a recording has: its timeline.
#pragma once

#include "player.h"
#include "survey.h"
#include "viewer.h"

namespace lidar_obstacles::apps {

/// A bar from the first scan to the last: how far it is surveyed, marks (new track green, lost track orange, ground
/// lost red, late scan yellow, phantom magenta, sensor fault blue, slow scan grey), the range that is played, where the
/// shown scan is. A click or a drag seeks.
/// @param bar  set to where the bar is [pixels].
void drawTimeline(Player& player, const Survey& survey, const ScreenRect& at, ScreenRect& bar);

}  // namespace lidar_obstacles::apps
