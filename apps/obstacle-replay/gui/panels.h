// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The panels that only a recording has: its timeline, and its parameters.
#pragma once

#include "controls.h"
#include "player.h"
#include "survey.h"
#include "viewer.h"

namespace lidar_obstacles::apps {

/// A bar from the first scan to the last: how far it is surveyed, marks (new track green, lost track orange, ground
/// lost red, late scan yellow, phantom magenta, sensor fault blue, slow scan grey), the range that is played, where the
/// shown scan is. A click or a drag seeks.
/// @param bar  set to where the bar is [pixels].
void drawTimeline(Player& player, const Survey& survey, const ScreenRect& at, ScreenRect& bar);

/// What drawParameters() has drawn, for tests.
struct DrawnParameters {
    std::vector<std::string> open_groups = {};  ///< their sections
    std::vector<std::string> starred = {};      ///< "section.key" of the rows with a star
};

/// The parameters in groups that fold, the changed ones with a star and in yellow; a click chooses one.
/// @param shown  the parameter that was chosen in the last frame; its group is opened when it changes.
DrawnParameters drawParameters(const DetectorParams& params, ParamPanel& panel, std::size_t& shown);

}  // namespace lidar_obstacles::apps
