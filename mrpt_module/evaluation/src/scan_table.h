// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The scans of a set, and which rows belong to each.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "lidar_obstacles/evaluation/evaluate.h"

namespace lidar_obstacles::evaluation {

struct Scan {
    double timestamp = 0.0;
    int scan_index = -1;  ///< -1 where neither truth nor ego poses name it
    std::vector<TruthObject> objects;
    std::vector<Detection> detections;  ///< structure too
};

struct ScanTable {
    std::vector<Scan> scans;  ///< by time
    std::size_t lost = 0;     ///< claims (asked.h) of no scan
};

/// The scans that `options` ask about. @throws std::runtime_error if there is no scan.
ScanTable tabulateScans(const LabelledSet& set, const EvaluationOptions& options);

}  // namespace lidar_obstacles::evaluation
