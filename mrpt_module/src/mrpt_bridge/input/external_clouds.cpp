#include "mrpt_bridge/input/external_clouds.h"

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CRawlog.h>

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

ExternalClouds::ExternalClouds(const std::string& rawlog)
    : folders_{mrpt::obs::CRawlog::detectImagesDirectory(rawlog), fs::path(rawlog).parent_path().string(), "."} {
    if (folders_[1].empty()) folders_[1] = ".";
}

std::string ExternalClouds::load(mrpt::obs::CObservation& observation) const {
    auto* cloud = dynamic_cast<Cloud*>(&observation);
    if (!cloud || !cloud->isExternallyStored()) return "";
    const fs::path file = cloud->getExternalStorageFile();
    for (const std::string& folder : folders_) {
        std::error_code ec;
        if (!fs::is_regular_file(fs::path(folder) / file, ec)) continue;  // an absolute path stays what it is
        try {
            loadFrom(folder, *cloud);
            if (!cloud->pointcloud) return file.string() + ": no points in it";
            cloud->overrideExternalStorageFormatFlag(Cloud::ExternalStorageFormat::None);
            return "";
        } catch (const std::exception& e) {  // also bad_alloc, from a length that cannot be right
            return (fs::path(folder) / file).string() + ": " + reasonOf(e);
        }
    }
    return file.string() + ": no such file in " + folders_[0] + " or beside the rawlog";
}

}  // namespace lidar_obstacles
