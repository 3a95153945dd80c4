// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is learned from: the hypotheses of simulated scans, their features, and what they are.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "lidar_obstacles/features.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/recognizer.h"
#include "lidar_obstacles/simulation/labels.h"

namespace lidar_obstacles::apps {

/// The id of a return of which nobody knows what it hit: too near to a box to be surely beside it, or out of the view
/// that was labelled.
constexpr std::int16_t kUnsure = std::numeric_limits<std::int16_t>::min();

/// A hypothesis of a scan: what stands in the tree of merges, what was measured, and the truth.
struct Sample {
    FeatureVector features{};
    Category truth = Category::Unknown;
    Category verdict = Category::Unknown;  ///< the truth where most of an object stands for it
    int thing = 0;                         ///< that most of its returns belong to; 0: structure or ground
    std::int32_t returns = 0;
    std::array<int, 2> part{-1, -1};  ///< places in the same scan's list
    int parent = -1;
    bool chosen = false;  ///< by the model that was used: its surroundings were measured too
    bool known = true;    ///< what it is; otherwise it is neither learned from nor judged
};

/// All hypotheses of one scan, in the order of its tree.
using ScanSamples = std::vector<Sample>;

/// What each hypothesis of a detection is, by the labels of its returns.
///
/// A group is a whole object where nine in ten of its returns are the object's, and nine in ten of the object's returns
/// that may be obstacles are in it, not most of any other object, and nothing else half a metre outside of what is the
/// object's; all structure, ground and noise counts as one thing, of which every piece is whole. What would be a part
/// of an object is a mixture by the same rules.
struct Truth {
    Category category = Category::Unknown;
    /// The same, but a whole is what has more than half of an object's returns, wherever the other ones lie.
    Category verdict = Category::Unknown;
    int thing = 0;
    bool known = true;  ///< nine in ten of its returns are not kUnsure
};
std::vector<Truth> truthOf(const DetectionResult& result, const PointCloud& cloud,
                           const std::vector<simulation::ReturnLabel>& labels);

/// Measures all hypotheses of a scan, with the tree, the choice and the surroundings that the parameters' model gives.
/// @param labels  one for each return of the cloud.
ScanSamples samplesOfScan(const PointCloud& cloud, const std::vector<simulation::ReturnLabel>& labels,
                          const DetectorParams& params);

struct SceneChoice {
    std::uint64_t seed = 0;
    int kind = 0;    ///< place in simulation::randomScenes()
    int stride = 8;  ///< every so many turns of the sensor
    /// Of the detector. Its recognizer scores, cuts and joins: its mistakes are learned from.
    DetectorParams params;
    std::optional<double> noise;  ///< of the ranges, standard deviation [m]; none: as the scene draws it
};

/// Simulates a random scene and measures its scans with 16, 8 and 4 rings.
std::vector<ScanSamples> samplesOfScene(const SceneChoice& choice);

}  // namespace lidar_obstacles::apps
