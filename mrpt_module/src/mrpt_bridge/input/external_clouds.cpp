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
void ExternalClouds::loadNamed(const ExternalFiles::Place& place, Cloud& cloud) {
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

std::string ExternalClouds::load(mrpt::obs::CObservation& observation) const {
    auto* cloud = dynamic_cast<Cloud*>(&observation);
    if (!cloud || !cloud->isExternallyStored()) return "";
    const std::string stored = cloud->getExternalStorageFile();
    const auto place = files_.find(stored);
    if (!place) return stored + ": no such file in " + files_.folder().string() + " or beside the rawlog";
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
