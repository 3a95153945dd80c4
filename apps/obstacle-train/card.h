/// @file
/// The model's card: where it comes from and how good it is.
#pragma once

#include <string>
#include <vector>

#include "boosting.h"
#include "calibration.h"

namespace lidar_obstacles::apps {

struct Training {
    int scenes = 0;
    std::uint64_t seed = 0;
    BoostingOptions boosting;
    std::size_t groups = 0;        ///< that grouping learned from
    std::size_t verdicts = 0;      ///< and the verdict
    std::vector<std::string> set;  ///< parameters of the detector other than the defaults
};

/// Markdown.
std::string cardText(const Training& training, const Judgement& judgement);

}  // namespace lidar_obstacles::apps
