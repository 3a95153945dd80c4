// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Obstacles as JSON: one line per scan, in files and live.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lidar_obstacles/health.h"
#include "lidar_obstacles/types.h"
#include "lidar_obstacles/zones.h"

namespace lidar_obstacles::apps {

/// What else is known of a scan; what is not set is left out.
struct JsonExtras {
    const HealthReport* health = nullptr;        ///< `"health":{..}`
    const ZoneMonitor* zones = nullptr;          ///< `"zones":[..]`
    const std::vector<LowThing>* low = nullptr;  ///< `"low":[..]`
};

/// One obstacle, as in jsonLine().
nlohmann::ordered_json obstacleJson(const Obstacle& obstacle);

/// One scan: `{"timestamp":..,"scan_index":..,"obstacles":[..]}` and a line end. The obstacles' keys are the columns
/// of obstacles.csv; `max_height` is null where nothing passed above. With tracking there are also `probability`,
/// `age`, `seen`, `velocity` and `velocity_std` ([x, y] or null), `moving`, `direction_known`, `yaw_std`, `center_std`
/// and `time_offset`.
std::string jsonLine(double timestamp, std::size_t scan_index, const std::vector<Obstacle>& obstacles,
                     const JsonExtras& extras = {});

}  // namespace lidar_obstacles::apps
