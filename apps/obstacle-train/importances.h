// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the trees of a model ask for most.
#pragma once

#include <string>

namespace lidar_obstacles::apps {

/// Markdown: for each of the two forests the twelve features that weigh most among the questions of its trees. The
/// first question of a tree weighs 1, each of the next two half of it, and so on: about the share of the groups that
/// are asked it.
/// @param model  text of a model file that Recognizer::parse() takes
std::string importancesText(const std::string& model);

}  // namespace lidar_obstacles::apps
