// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which detection of a scan is which object.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "lidar_obstacles/evaluation/detections.h"
#include "lidar_obstacles/evaluation/truth.h"

namespace lidar_obstacles::evaluation {

struct MatchOptions {
    double min_iou = 0.05;            ///< a pair whose footprints overlap by so much may match
    double max_distance = 2.0;        ///< ... or whose centres are no farther apart [m]
    double max_distance_small = 1.0;  ///< the same for pedestrians and cyclists [m]
    bool class_aware = false;         ///< a detection with a class matches objects of its group only
};

/// The assignment of least total cost (Hungarian algorithm, n^3).
/// @param cost  square, finite.
/// @return the column of each row; empty for an empty matrix.
/// @throws std::invalid_argument if it is not square.
std::vector<int> minimumCostAssignment(const Eigen::MatrixXd& cost);

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/// The pairs (row, column) of largest total score, each row and column at most once; a score of 0 is no pair.
/// @param score  of each row with each column, finite, not negative; may be empty.
IndexPairs pairsOfLargestScore(const Eigen::MatrixXd& score);

/// Pairs (object, detection), as indices, of one scan; each at most once. A pair is admissible if the footprints
/// overlap, or the detection lies mostly on the object, or the centres are near; the sum of scores is largest, where
/// overlap counts first, then how much of the detection lies on the object, then the distance of the centres.
IndexPairs matchBoxes(const std::vector<TruthObject>& objects, const std::vector<Detection>& detections,
                      const MatchOptions& options);

}  // namespace lidar_obstacles::evaluation
