// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An obstacle in words: its numbers, and why it is what it is.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/scene_layers.h"

namespace lidar_obstacles::apps {

/// A line of a panel.
struct Line {
    std::string name;
    std::string value;
    std::string meaning = {};  ///< "" where it needs none
};

/// Class and probability, size, speed, distance, age, returns, heading; "-" for what is not known.
std::vector<Line> numbersOf(const Obstacle& obstacle);

/// What it was told for, the pieces it was made of, the merges that were taken or refused with the returns in whole
/// objects either way, and what was sorted out within 3 m. One line without hypotheses: it was made without the
/// recognizer, or nothing of it was seen in this scan.
std::vector<std::string> reasonsOf(const Obstacle& obstacle, const LayerData& scan);

/// What the recognizer measured of it: name, value and unit of each feature. Empty where nothing was weighed for it.
std::vector<Line> featuresOf(const Obstacle& obstacle, const LayerData& scan);

}  // namespace lidar_obstacles::apps
