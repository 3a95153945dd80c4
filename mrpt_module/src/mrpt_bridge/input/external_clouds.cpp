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

// CRawlog::detectImagesDirectory() looks for the same names, but not in other folders than the current one: it forgets
// the separator (MRPT 2.5).
ExternalClouds::ExternalClouds(const std::string& rawlog) {
    const fs::path path = rawlog;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    fs::path name = path.stem();
    if (path.extension() == ".gz") name = name.stem();  // drive.rawlog.gz
    for (const char* end : {"_Images", "_images", "_IMAGES"}) folders_.push_back(folder / (name.string() + end));
    folders_.push_back(folder / "Images");
    folders_.push_back(folder);
    folders_.emplace_back(".");
}

std::string ExternalClouds::load(mrpt::obs::CObservation& observation) const {
    auto* cloud = dynamic_cast<Cloud*>(&observation);
    if (!cloud || !cloud->isExternallyStored()) return "";
    const fs::path file = cloud->getExternalStorageFile();
    for (const fs::path& folder : folders_) {
        std::error_code ec;
        if (!fs::is_regular_file(folder / file, ec)) continue;  // an absolute path stays what it is
        try {
            loadFrom(folder.string(), *cloud);
            if (!cloud->pointcloud) return file.string() + ": no points in it";
            cloud->overrideExternalStorageFormatFlag(Cloud::ExternalStorageFormat::None);
            return "";
        } catch (const std::exception& e) {  // also bad_alloc, from a length that cannot be right
            return (folder / file).string() + ": " + reasonOf(e);
        }
    }
    return file.string() + ": no such file in " + folders_[0].string() + " or beside the rawlog";
}

}  // namespace lidar_obstacles
