// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Boosted trees by XGBoost, and the model file made of them.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "samples.h"

namespace lidar_obstacles::apps {

struct BoostingOptions {
    int rounds = 80;
    int depth = 8;
    double rate = 0.2;
    int seed = 1;
    std::set<Feature> left_out;  ///< nothing is learned from these
};

/// One tree as lines of a model file.
using TreeText = std::string;

/// Trees for each category in turn. The same samples give the same trees.
/// The forest that groups learns from all features but those of surroundings, and what is whole; the one that gives the
/// verdict from all, and what is most of an object.
/// @throws std::runtime_error with XGBoost's message.
std::vector<TreeText> boost(const std::vector<const Sample*>& samples, Recognizer::Forest forest,
                            const BoostingOptions& options);

struct Forest {
    std::vector<TreeText> trees;
    Calibration calibration;
};

/// The first lines of a model file: the ranges of the features in the samples; any value of those that were left out.
std::string rangesText(const std::vector<const Sample*>& samples, const std::set<Feature>& left_out = {});
/// The whole model file.
std::string modelText(const std::string& ranges, const Forest& grouping, const Forest& verdict);

}  // namespace lidar_obstacles::apps
