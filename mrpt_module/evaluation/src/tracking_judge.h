// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Counts what is told of classes, tracks and velocities.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/evaluate.h"
#include "scan_table.h"

namespace lidar_obstacles::evaluation {

/// @param name  of the set.
TrackingResult judgeTracking(const std::string& name, const std::vector<Scan>& scans, const EvaluationOptions& options);

// ---------------------------------------------------------------- its parts

/// A scan whose ignored objects are of group Other.
using JudgedScans = std::vector<Scan>;

/// Objects and boxes of one group in one scan; what stands on what is neither wanted nor false is left out.
struct TrackedScan {
    double timestamp = 0.0;
    std::vector<const TruthObject*> objects;
    std::vector<const Detection*> boxes;
};

/// One object and the box that tells of it, in order of scans.
struct TrackedPair {
    double timestamp = 0.0;
    const TruthObject* object = nullptr;
    const Detection* box = nullptr;
};

/// How well a box fits an object, class aside; 0: not at all.
double fitOf(const TruthObject& object, const Detection& box, JudgedGroup group);

/// Whether a box may speak for an object of the group.
bool isBoxOf(const Detection& box, JudgedGroup group, const EvaluationOptions& options);

ClassCounts countClasses(const JudgedScans& scans, JudgedGroup group, const EvaluationOptions& options);
BlindCounts countBlind(const std::string& set, const JudgedScans& scans, const EvaluationOptions& options);
HotaCounts countHota(const std::vector<TrackedScan>& scans, JudgedGroup group);
/// @param pairs  gets what was matched.
ClearCounts countClear(const std::vector<TrackedScan>& scans, JudgedGroup group, std::vector<TrackedPair>& pairs);
VelocityCounts countVelocities(const std::vector<TrackedPair>& pairs);
JitterCounts countJitter(const std::vector<TrackedPair>& pairs);

}  // namespace lidar_obstacles::evaluation
