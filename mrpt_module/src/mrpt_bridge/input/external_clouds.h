// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Point clouds that a rawlog stores in files of their own.
#pragma once

#include <mrpt/obs/CObservationPointCloud.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// Reads the clouds of CObservationPointCloud that are stored beside a rawlog: in MRPT's folder for them (NAME_Images/,
/// NAME_images/, NAME_IMAGES/ or Images/), in the rawlog's own folder or in the current one, whichever has the file; of
/// a link to a rawlog also those beside its target. A file that is not where the rawlog says is looked for by its name
/// alone: rawlogs move, and come from systems with other separators.
class ExternalClouds {
  public:
    /// @param rawlog  path of the rawlog.
    explicit ExternalClouds(const std::string& rawlog);

    /// Reads the points of an observation that has them in a file, after which it holds them itself; does nothing to
    /// any other observation.
    /// @return why they cannot be read, with the file's name; empty if there is nothing wrong.
    std::string load(mrpt::obs::CObservation& observation) const;

  private:
    struct Place {
        std::filesystem::path folder;
        std::string file;  ///< in it
    };

    static void loadNamed(const Place& place, mrpt::obs::CObservationPointCloud& cloud);
    void addFoldersOf(const std::filesystem::path& rawlog);
    std::optional<Place> find(const std::string& stored) const;

    std::vector<std::filesystem::path> folders_;  ///< in which files are looked for
};

}  // namespace lidar_obstacles
