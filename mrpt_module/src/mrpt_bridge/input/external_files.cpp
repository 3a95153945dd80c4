// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/external_files.h"

namespace lidar_obstacles {

namespace fs = std::filesystem;

// CRawlog::detectImagesDirectory() looks for the same names, but not in other folders than the current one: it forgets
// the separator (MRPT 2.5).
ExternalFiles::ExternalFiles(const std::string& rawlog) {
    addFoldersOf(rawlog);
    std::error_code ec;
    const fs::path target = fs::canonical(rawlog, ec);  // a link may stand elsewhere
    if (!ec && fs::is_symlink(rawlog, ec)) addFoldersOf(target);
    folders_.emplace_back(".");
}

void ExternalFiles::addFoldersOf(const fs::path& rawlog) {
    const fs::path folder = rawlog.has_parent_path() ? rawlog.parent_path() : fs::path(".");
    fs::path name = rawlog.stem();
    if (rawlog.extension() == ".gz") name = name.stem();  // drive.rawlog.gz
    for (const char* end : {"_Images", "_images", "_IMAGES"}) folders_.push_back(folder / (name.string() + end));
    folders_.push_back(folder / "Images");
    folders_.push_back(folder);
}

/// The file where it was recorded, with its own folders if it has some; else by its name alone.
std::optional<ExternalFiles::Place> ExternalFiles::find(const std::string& stored) const {
    const std::size_t end_of_folder = stored.find_last_of("/\\");  // of either system
    const std::string name = end_of_folder == std::string::npos ? stored : stored.substr(end_of_folder + 1);
    for (const std::string& file : {stored, name})
        for (const fs::path& folder : folders_) {
            std::error_code ec;
            // an absolute path stays what it is
            if (!file.empty() && fs::is_regular_file(folder / file, ec)) return Place{folder, file};
        }
    return std::nullopt;
}

}  // namespace lidar_obstacles
