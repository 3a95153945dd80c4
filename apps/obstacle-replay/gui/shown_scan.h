// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One scan as the window shows it: decoded and run through the detector.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/scene_layers.h"
#include "lidar_obstacles/params.h"

namespace lidar_obstacles::apps {

/// Which returns of a sensor in dual return mode are kept (keys 1 and 2 of MRPT's velodyne-view).
struct DualReturns {
    bool last = true;
    bool strongest = true;
};

struct ShownScan : LayerData {
    std::size_t scan_index = 0;
    double decode_ms = 0.0;
    std::string error;  ///< why the scan in the file cannot be right; there is no cloud then
    std::string used;   ///< of time and space: poses, de-skewing, 3D filter, several scans; empty if nothing was
    std::optional<Eigen::Isometry3d> T_map_vehicle;  ///< at the scan's timestamp, where poses are used and known

    /// What was found in it with these parameters, and what the detector knows after it.
    void take(SequenceResult found, const ObstacleDetector& detector, const DetectorParams& params);
};

/// What the detector is run with.
struct DetectorSetup {
    DetectorParams params;
    DualReturns dual;
    ZoneSet zones = {};  ///< to watch; empty: none
};

/// Decodes a scan. One that cannot be right gives an empty one that says why.
/// @throws std::invalid_argument if the parameters do not fit the sensor.
std::shared_ptr<ShownScan> decodeScan(const mrpt::obs::CObservation& scan, std::size_t scan_index,
                                      const DetectorSetup& setup);

/// How long it took to decode and to search it [ms].
double totalMs(const ShownScan& scan);

/// What of time and space was used for a scan, in one line: "pose: at; de-skewed; 3D filter: 312 returns out".
std::string usedText(const SequenceResult& found, const DetectorParams& params);

/// Labelled objects by the number of their scan.
using TruthByScan = std::map<std::size_t, std::vector<TruthBox>>;

/// Reads a `*_gt.csv`: the poses at which the laser saw the objects. Objects without returns are left out.
/// @throws std::runtime_error naming the file and what is wrong with it, or that this program cannot read any.
TruthByScan readTruthByScan(const std::string& file);

}  // namespace lidar_obstacles::apps
