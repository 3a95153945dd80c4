// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What was found in a scan as an observation, so that programs hand it on in rawlogs.
#pragma once

#include <mrpt/obs/CObservationRFID.h>

#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// The obstacles of one scan, vehicle frame, metres and radians.
struct ScanResults {
    double timestamp = 0.0;           ///< of the scan [s since the epoch]
    std::string scan_label;           ///< its sensorLabel
    std::vector<Obstacle> obstacles;  ///< without `points`, `hull` and `marks`, which belong to the scan's cloud
};

/// The version of the text that toResultsObservation() writes; all up to it are read.
constexpr int kResultsVersion = 1;

/// The results as an observation of a class that every program with MRPT knows: a reader stops at a class that it does
/// not know. Of MRPT's classes CObservationRFID carries rows of text and its label through a rawlog; a
/// CObservationComment would take the place of the rawlog's own. Its first row is the head, each other one an obstacle:
///
/// | antennaPort         | epc (JSON)                                                                           |
/// |---------------------|--------------------------------------------------------------------------------------|
/// | `lidar_obstacles 1` | the version; `timestamp`, `scan_label`, `obstacles` (their number)                   |
/// | `vehicle 12`        | class and id; all numbers of the obstacle, none rounded                              |
///
/// Stamped as the scan; `sensorLabel` is that of the scan with "_results" behind it, or "results" where it has none.
/// @throws std::invalid_argument if a number is not finite; `max_height` may be infinite.
mrpt::obs::CObservationRFID::Ptr toResultsObservation(const ScanResults& results);

/// The results that an observation holds: all that was written, bit for bit. nullopt if it is another observation.
/// @throws std::runtime_error if they are of a newer version, or damaged.
std::optional<ScanResults> readResults(const mrpt::obs::CObservation& observation);

}  // namespace lidar_obstacles
