// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Point clouds that a rawlog stores in files of their own.
#pragma once

#include <mrpt/obs/CObservationPointCloud.h>

#include <string>

#include "lidar_obstacles/mrpt_bridge/external_files.h"

namespace lidar_obstacles {

/// Reads the clouds of CObservationPointCloud that are stored beside a rawlog, where ExternalFiles finds them.
class ExternalClouds {
  public:
    /// @param rawlog  path of the rawlog.
    explicit ExternalClouds(const std::string& rawlog) : files_(rawlog) {}

    /// Reads the points of an observation that has them in a file, after which it holds them itself; does nothing to
    /// any other observation.
    /// @return why they cannot be read, with the file's name; empty if there is nothing wrong.
    std::string load(mrpt::obs::CObservation& observation) const;

  private:
    static void loadNamed(const ExternalFiles::Place& place, mrpt::obs::CObservationPointCloud& cloud);

    ExternalFiles files_;
};

}  // namespace lidar_obstacles
