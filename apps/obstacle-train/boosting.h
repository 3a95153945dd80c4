/// @file
/// Boosted trees by XGBoost, and the model file made of them.
#pragma once

#include <string>
#include <vector>

#include "samples.h"

namespace lidar_obstacles::apps {

struct BoostingOptions {
    int rounds = 60;
    int depth = 6;
    double rate = 0.2;
    int seed = 1;
};

/// One tree as lines of a model file.
using TreeText = std::string;

/// Trees for each category in turn. The same samples give the same trees.
/// @throws std::runtime_error with XGBoost's message.
std::vector<TreeText> boost(const std::vector<const Sample*>& samples, const BoostingOptions& options);

/// What calibration adds to the sums of the trees.
struct Calibration {
    float sharpness = 1.0f;
    std::array<float, kCategories> bias{};
};

/// The whole model file; ranges of the features are those of the samples.
std::string modelText(const std::vector<const Sample*>& samples, const std::vector<TreeText>& trees,
                      const Calibration& calibration);

}  // namespace lidar_obstacles::apps
