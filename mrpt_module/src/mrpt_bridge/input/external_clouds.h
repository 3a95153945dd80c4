/// @file
/// Point clouds that a rawlog stores in files of their own.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <filesystem>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// Reads the clouds of CObservationPointCloud that are stored beside a rawlog: in MRPT's folder for them (NAME_Images/,
/// NAME_images/, NAME_IMAGES/ or Images/), in the rawlog's own folder or in the current one, whichever has the file.
class ExternalClouds {
  public:
    /// @param rawlog  path of the rawlog.
    explicit ExternalClouds(const std::string& rawlog);

    /// Reads the points of an observation that has them in a file, after which it holds them itself; does nothing to
    /// any other observation.
    /// @return why they cannot be read, with the file's name; empty if there is nothing wrong.
    std::string load(mrpt::obs::CObservation& observation) const;

  private:
    std::vector<std::filesystem::path> folders_;  ///< in which files are looked for
};

}  // namespace lidar_obstacles
