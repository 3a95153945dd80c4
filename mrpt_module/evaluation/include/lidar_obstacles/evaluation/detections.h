// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Detections as they stand in an obstacles.csv.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/truth.h"

namespace lidar_obstacles::evaluation {

/// What a file says of an obstacle beyond its box; NaN where it says nothing.
struct ToldTrack {
    static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    double probability = kUnknown;                 ///< that it is of its class
    Eigen::Vector2d velocity{kUnknown, kUnknown};  ///< over ground, vehicle axes [m/s]
    double moving = kUnknown;                      ///< 0 or 1
    double direction_known = kUnknown;             ///< 1: its yaw points to its front; 0: modulo 180 degrees
    double age = kUnknown;                         ///< of the track [s]
    double seen = kUnknown;                        ///< 0: predicted, nothing of it was seen in this scan
};

/// One obstacle of one scan; vehicle frame.
struct Detection {
    double timestamp = 0.0;  ///< of the scan [s]
    int scan_index = 0;
    std::string id;
    std::string cls;  ///< lower case; the detector's four classes, or whatever another detector calls it
    Group group = Group::Other;
    OrientedBox box;
    bool heading_valid = false;
    int num_points = 0;
    double range = 0.0;  ///< from the vehicle's origin to its nearest point, seen from above [m]
    ToldTrack track;
};

/// Reads an obstacles.csv, as strictly as the truth; a file with a header only holds no detections.
/// @throws CsvError; std::runtime_error naming the file if it cannot be read.
std::vector<Detection> readDetections(const std::string& file);

}  // namespace lidar_obstacles::evaluation
