// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Files that a rawlog names: points and images that are not stored in itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// Looks in MRPT's folders for them beside the rawlog (NAME_Images/, NAME_images/, NAME_IMAGES/ or Images/), in the
/// rawlog's own folder and in the current one, whichever has the file; of a link to a rawlog also beside its target. A
/// file that is not where the rawlog says is looked for by its name alone: rawlogs move, and come from systems with
/// other separators. Its const members may be called by several threads at a time.
class ExternalFiles {
  public:
    struct Place {
        std::filesystem::path folder;
        std::string file;  ///< in it
    };

    /// @param rawlog  path of the rawlog.
    explicit ExternalFiles(const std::string& rawlog);

    /// @param stored  the name that the rawlog has for it. @return nothing if there is no such file.
    std::optional<Place> find(const std::string& stored) const;
    /// Where files are looked for first.
    const std::filesystem::path& folder() const { return folders_.front(); }

  private:
    void addFoldersOf(const std::filesystem::path& rawlog);

    std::vector<std::filesystem::path> folders_;
};

}  // namespace lidar_obstacles
