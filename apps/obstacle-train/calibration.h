/// @file
/// Probabilities that hold: fitted and judged on scenes that the trees were not trained on.
#pragma once

#include <array>
#include <vector>

#include "boosting.h"
#include "lidar_obstacles/recognizer.h"
#include "samples.h"

namespace lidar_obstacles::apps {

/// Fits sharpness and biases to the groups that the best cut chooses, by the likelihood of their true categories.
/// @param model  with the calibration that does nothing.
Calibration calibrate(const Recognizer& model, const std::vector<ScanSamples>& scans);

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
