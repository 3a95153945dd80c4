// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The truth file of a recording: which scans it labels, and their boxes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "box_labels.h"

namespace lidar_obstacles::apps {

/// The boxes of a truth file by the timestamps of its scans [s].
struct RecordingTruth {
    std::map<double, std::vector<LabelledBox>> scans;
    double reach = 0.0;  ///< to the farthest point of all boxes, seen from above [m]
};

/// @throws as openRecording (recordings.h).
RecordingTruth readRecordingTruth(const std::string& file);

/// The scan of the truth at this time, to 0.04 s; end() if there is none.
std::map<double, std::vector<LabelledBox>>::const_iterator scanAt(const RecordingTruth& truth, double time);

}  // namespace lidar_obstacles::apps
