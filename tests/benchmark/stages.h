// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is timed, each as a benchmark named `<what>/<data set>`.
#pragma once

#include <opencv2/core.hpp>

#include "data_sets.h"

namespace lidar_obstacles::bench {

inline constexpr const char* kFloor = "floor";

/// What the floor keeps between scans.
struct FloorMemory {
    cv::Mat1f lowest;
    cv::Mat1f highest;
    cv::Mat1b occupied;
    cv::Mat1i labels;
};

/// The least that any grid method does with a scan: reads the returns, bins them into a 400 x 400 grid with their
/// lowest and highest z, marks the cells with a difference, and finds connected components.
/// @return number of components.
int floorOfGridMethods(const PointCloud& cloud, FloorMemory& memory);

/// Registers the floor, the pipeline, its stages and, where the set has packets, decoding. Keeps references to `set`.
void registerBenchmarks(const DataSet& set);

}  // namespace lidar_obstacles::bench
