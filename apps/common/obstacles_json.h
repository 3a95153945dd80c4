/// @file
/// Obstacles as JSON: one line per scan, in files and live.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// One scan: `{"timestamp":..,"scan_index":..,"obstacles":[..]}` and a line end. The obstacles' keys are the columns
/// of obstacles.csv; `max_height` is null where nothing passed above. With tracking there are also `probability`,
/// `age`, `seen`, `velocity` and `velocity_std` ([x, y] or null), `moving`, `direction_known`, `yaw_std`, `center_std`
/// and `time_offset`.
/// @param latency_ms  told as well where it is known.
std::string jsonLine(double timestamp, std::size_t scan_index, const std::vector<Obstacle>& obstacles,
                     std::optional<double> latency_ms = std::nullopt);

}  // namespace lidar_obstacles::apps
