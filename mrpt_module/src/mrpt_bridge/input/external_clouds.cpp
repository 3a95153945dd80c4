// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/external_clouds.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <filesystem>
#include <mutex>

#include "mrpt_bridge/input/reason_of.h"

namespace lidar_obstacles {
namespace {

namespace fs = std::filesystem;
using Cloud = mrpt::obs::CObservationPointCloud;

/// Lets MRPT read the file from a folder. Its name for that folder is one for the whole program.
void loadFrom(const std::string& folder, const Cloud& cloud) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    const std::string before = mrpt::io::getLazyLoadPathBase();
    mrpt::io::setLazyLoadPathBase(folder);
    try {
        cloud.load();
    } catch (...) {
        mrpt::io::setLazyLoadPathBase(before);
        throw;
    }
    mrpt::io::setLazyLoadPathBase(before);
}

}  // namespace

/// Reads a file under another name than the observation has for it. MRPT does not say of which format it is.
void ExternalClouds::loadNamed(const Place& place, Cloud& cloud) {
    using Format = Cloud::ExternalStorageFormat;
    const auto loadAs = [&](Format format) {
        cloud.overrideExternalStorageFormatFlag(Format::None);  // MRPT refuses a second name otherwise
        cloud.setAsExternalStorage(place.file, format);
        loadFrom(place.folder.string(), cloud);
    };
    if (fs::path(place.file).extension() == ".txt") return loadAs(Format::PlainTextFile);
    try {
        loadAs(Format::MRPT_Serialization);
    } catch (const std::exception&) {
        loadAs(Format::KittiBinFile);
    }
}

// CRawlog::detectImagesDirectory() looks for the same names, but not in other folders than the current one: it forgets
// the separator (MRPT 2.5).
ExternalClouds::ExternalClouds(const std::string& rawlog) {
    addFoldersOf(rawlog);
    std::error_code ec;
    const fs::path target = fs::canonical(rawlog, ec);  // a link may stand elsewhere
    if (!ec && fs::is_symlink(rawlog, ec)) addFoldersOf(target);
    folders_.emplace_back(".");
}

void ExternalClouds::addFoldersOf(const fs::path& rawlog) {
    const fs::path folder = rawlog.has_parent_path() ? rawlog.parent_path() : fs::path(".");
    fs::path name = rawlog.stem();
    if (rawlog.extension() == ".gz") name = name.stem();  // drive.rawlog.gz
    for (const char* end : {"_Images", "_images", "_IMAGES"}) folders_.push_back(folder / (name.string() + end));
    folders_.push_back(folder / "Images");
    folders_.push_back(folder);
}

/// The file where it was recorded, with its own folders if it has some; else by its name alone.
std::optional<ExternalClouds::Place> ExternalClouds::find(const std::string& stored) const {
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

std::string ExternalClouds::load(mrpt::obs::CObservation& observation) const {
    auto* cloud = dynamic_cast<Cloud*>(&observation);
    if (!cloud || !cloud->isExternallyStored()) return "";
    const std::string stored = cloud->getExternalStorageFile();
    const auto place = find(stored);
    if (!place) return stored + ": no such file in " + folders_[0].string() + " or beside the rawlog";
    try {
        place->file == stored ? loadFrom(place->folder.string(), *cloud) : loadNamed(*place, *cloud);
        if (!cloud->pointcloud) return stored + ": no points in it";
        cloud->overrideExternalStorageFormatFlag(Cloud::ExternalStorageFormat::None);
        return "";
    } catch (const std::exception& e) {  // also bad_alloc, from a length that cannot be right
        return (place->folder / place->file).string() + ": " + reasonOf(e);
    }
}

}  // namespace lidar_obstacles
