// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parameters, to be looked at and chosen.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "param_panel.h"

namespace lidar_obstacles::apps {

/// What drawParameters() has drawn, for tests.
struct DrawnParameters {
    std::vector<std::string> open_groups = {};  ///< their sections
    std::vector<std::string> starred = {};      ///< "section.key" of the rows with a star
};

/// The parameters in groups that fold, the changed ones with a star and in yellow; a click chooses one.
/// @param shown  the parameter that was chosen in the last frame; its group is opened when it changes.
DrawnParameters drawParameters(const DetectorParams& params, ParamPanel& panel, std::size_t& shown);

}  // namespace lidar_obstacles::apps
