// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The run: scans in, obstacles out.
#pragma once

#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/params.h"
#include "options.h"
#include "outputs.h"
#include "summary.h"

namespace lidar_obstacles::apps {

/// Processes the selected scans of one lidar. Where the input is damaged, or a scan in it cannot be right, the run
/// ends there and `Summary::damage` says why. After a signal (common/interrupt.h) it ends before the next scan, and
/// `Summary::interrupted_at` says where.
///
/// @throws UsageError if the lidar is not clear (several, none of that label) or no scan is selected;
///     std::invalid_argument if the parameters do not fit the sensor; std::runtime_error if something cannot be
///     written or there is no scan in the input. No results are left where there was no scan.
Summary replay(ScanSource& source, const Options& options, const DetectorParams& params, Outputs& outputs);

}  // namespace lidar_obstacles::apps
