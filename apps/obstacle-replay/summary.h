// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a run found and how long it took, for summary.json.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/zone_rows.h"
#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"
#include "motion_summary.h"
#include "options.h"

namespace lidar_obstacles::apps {

struct Summary {
    std::size_t scans_in_input = 0;                                  ///< of the lidar, as far as was read
    std::size_t scans = 0;                                           ///< processed
    std::size_t returns = 0;                                         ///< valid returns of the processed scans
    std::map<std::string, std::size_t> obstacles;                    ///< by class
    std::map<std::string, std::size_t> rejected;                     ///< clusters by reason
    std::map<std::string, std::size_t> ground;                       ///< scans by evidence of the ground
    std::vector<std::pair<std::string, std::vector<float>>> timing;  ///< [ms] per stage and scan, in order of stages
    MotionSummary motion;                                            ///< poses, de-skewing, 3D filter
    ZonesTally watched;                                              ///< zones and health
    std::string sensor_label;
    std::optional<std::size_t> interrupted_at;  ///< first scan that a signal left out; not set: none
    bool moved = false;   ///< the vehicle, so far that what stays in place can be told from the world around
    OwnBody in_place;     ///< what stays in place around it: its own body, as far as that is not left out already
    std::string damage;   ///< why the input ended early; empty if it did not
    std::string remarks;  ///< what the reader left out

    /// Counts one scan. `decode_ms` and `total_ms` are wall times, total from the observation to the boxes.
    void add(const PointCloud& cloud, const DetectionResult& result, double decode_ms, double total_ms);
};

/// The text of summary.json.
std::string toJson(const Summary& summary, const Options& options, const DetectorParams& params);

}  // namespace lidar_obstacles::apps
