// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Low things, drops and missing ground as JSON and CSV.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lidar_obstacles/low_things.h"

namespace lidar_obstacles::apps {

/// `[{"kind":..,"x":..,"y":..,"nearest":[..],..}]`, see docs/zones.md.
nlohmann::ordered_json lowJson(const std::vector<LowThing>& low);

/// Header and rows of low_things.csv.
std::string lowCsvHeader();
std::string lowCsvRows(double timestamp, std::size_t scan_index, const std::vector<LowThing>& low);

}  // namespace lidar_obstacles::apps
