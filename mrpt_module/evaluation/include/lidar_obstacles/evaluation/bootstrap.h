// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Confidence intervals from resampled objects.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/evaluate.h"

namespace lidar_obstacles::evaluation {

struct Interval {
    double low = 0.0;
    double high = 0.0;
};

/// 95 % intervals of rates and means, by name: `recall`, `face_mean`, `face_mae` [m] ..., headings in degrees.
using Intervals = std::map<std::string, Interval>;

struct BootstrapOptions {
    int replicates = 1000;  ///< 0: no intervals
    std::uint64_t seed = 1;
};

/// A counted row and the object it belongs to, as a number that is unique over all sets.
struct CountedRow {
    const ObjectRecord* record = nullptr;
    std::size_t object = 0;
};

/// Percentile bootstrap (Efron and Tibshirani 1993, ch. 13) over objects: rows of one object are alike, so objects are
/// drawn with replacement, each with all of its rows. Same rows in the same order and same seed, same intervals.
/// @return an interval for each quantity that has one; none with fewer than two objects.
/// @throws std::invalid_argument if replicates < 0.
Intervals bootstrapOverObjects(const std::vector<CountedRow>& rows, const BootstrapOptions& options);

}  // namespace lidar_obstacles::evaluation
