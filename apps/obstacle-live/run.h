// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The run: scans from the reader's queue, obstacles out.
#pragma once

#include <atomic>

#include "lidar_obstacles/params.h"
#include "options.h"
#include "statistics.h"

namespace lidar_obstacles::apps {

struct RunResult {
    Statistics statistics;
    std::string error;  ///< what went wrong on the way, all files are complete nevertheless; empty if nothing
};

/// Runs until the source ends, `stop` is set or the time is over.
/// @throws std::runtime_error if it cannot begin; std::invalid_argument if the parameters do not fit the sensor.
RunResult run(const Options& options, const DetectorParams& params, const std::atomic<bool>& stop);

}  // namespace lidar_obstacles::apps
