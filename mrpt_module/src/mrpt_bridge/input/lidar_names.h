// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which scans are of the same lidar.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <map>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// Tells lidars apart that were recorded under one label: by the class of their observations and their place on the
/// vehicle. The first lidar of a label has the label as its name, further ones add a number: "front", "front#2".
///
/// A scan belongs to the lidar of its label and class whose last `sensorPose` was within 0.1 m and 10 deg of its own,
/// so a lidar that is tilted slowly stays the same one.
class LidarNames {
  public:
    /// Name of the lidar of a scan; the scans are to be given in their order.
    std::string nameOf(const mrpt::obs::CObservation& scan);

  private:
    struct Lidar {
        std::string class_name;
        mrpt::poses::CPose3D T_vehicle_sensor;  ///< of its last scan
    };
    std::map<std::string, std::vector<Lidar>> lidars_;  ///< by label
};

}  // namespace lidar_obstacles
