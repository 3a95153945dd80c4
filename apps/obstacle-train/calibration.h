// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Probabilities that hold: fitted and judged on scenes that the trees were not trained on.
#pragma once

#include <array>
#include <vector>

#include "boosting.h"
#include "lidar_obstacles/recognizer.h"
#include "samples.h"

namespace lidar_obstacles::apps {

/// A chosen group: what the trees say, and the truth.
struct Chosen {
    std::array<float, kCategories> scores{};
    Category truth = Category::Unknown;
};

/// What the model chooses when it groups the scans anew.
std::vector<Chosen> chosenAnew(const Recognizer& model, const std::vector<ScanSamples>& scans);
/// What was chosen in the scans, as the model judges it in its surroundings.
std::vector<Chosen> chosenOnceMore(const Recognizer& model, const std::vector<ScanSamples>& scans);

/// Fits sharpness and biases by the likelihood of the true categories. Those that change nothing if there are none.
Calibration calibrate(const std::vector<Chosen>& groups);

/// How the chosen groups of some scans come out.
struct Judgement {
    std::array<std::array<int, kCategories>, 5> confusion{};  ///< [class told][category in truth]
    std::array<double, 5> calibration_error{};                ///< of each class told, ten bins
    std::size_t scans = 0;
    /// Vehicles and people of at least 15 returns: all, those of which a whole hypothesis was made, and chosen.
    std::array<int, 3> vehicles{}, people{};
};
Judgement judge(const Recognizer& model, const std::vector<ScanSamples>& scans);

}  // namespace lidar_obstacles::apps
