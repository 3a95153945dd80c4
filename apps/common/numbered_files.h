// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Files that a run writes one by one, with the number of the scan in their names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lidar_obstacles::apps {

/// `<begin>NNNNNN<end>`, at least six digits, e.g. "picture_" and ".png".
struct NumberedName {
    std::string begin;
    std::string end;
};

/// Takes the files with such names out of a folder, so that an earlier run leaves nothing beside what the next one
/// writes. A folder that is not there, or a file that cannot be removed, is no error.
void removeNumbered(const std::filesystem::path& folder, const std::vector<NumberedName>& names);

}  // namespace lidar_obstacles::apps
