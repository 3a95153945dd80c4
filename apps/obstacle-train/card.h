// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The model's card: where it comes from and how good it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "boosting.h"
#include "calibration.h"
#include "recordings.h"

namespace lidar_obstacles::apps {

struct Training {
    int scenes = 0;
    std::uint64_t seed = 0;
    BoostingOptions boosting;
    std::size_t groups = 0;        ///< that grouping learned from
    std::size_t verdicts = 0;      ///< and the verdict
    std::vector<std::string> set;  ///< parameters of the detector other than the defaults
    std::vector<Recording> recordings;
    std::optional<double> noise;  ///< of the ranges in all scenes [m]; none: drawn
};

/// The scans that were kept back: of all, and of the recordings alone.
struct Judgements {
    Judgement all, recorded;
};

/// Markdown.
std::string cardText(const Training& training, const Judgements& judgements);

}  // namespace lidar_obstacles::apps
