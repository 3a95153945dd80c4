/// @file
/// Detections as they stand in an obstacles.csv.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/truth.h"

namespace lidar_obstacles::evaluation {

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
};

/// Reads an obstacles.csv, as strictly as the truth; a file with a header only holds no detections.
/// @throws CsvError; std::runtime_error naming the file if it cannot be read.
std::vector<Detection> readDetections(const std::string& file);

}  // namespace lidar_obstacles::evaluation
