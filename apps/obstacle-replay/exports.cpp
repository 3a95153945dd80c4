#include "exports.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "common/kitti_labels.h"
#include "common/number_text.h"
#include "common/numbered_files.h"
#include "common/obstacles_csv.h"
#include "common/zone_rows.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

/// Takes away what an earlier run left; a file that grows under a name that is wanted is begun anew anyway.
void removeOld(const fs::path& folder, const ExportFormats& formats) {
    std::error_code ignored;
    for (const auto& [name, wanted] : {std::pair("obstacles.csv", formats.csv),
                                       {"obstacles.jsonl", formats.jsonl},
                                       {"kitti_tracking.txt", formats.kitti_tracking},
                                       {"zones.csv", formats.zones},
                                       {"matched_poses.csv", formats.poses}}) {
        fs::remove(folder / name, ignored);
        if (!wanted) fs::remove(folder / (std::string(name) + ".part"), ignored);
    }
    removeNumbered(folder / "kitti", {{"", ".txt"}, {"", ".txt.part"}});
}

}  // namespace

ExportFormats parseFormats(const std::vector<std::string>& words) {
    ExportFormats formats;
    formats.csv = false;
    for (const std::string& word : words) {
        if (word == "csv")
            formats.csv = true;
        else if (word == "jsonl")
            formats.jsonl = true;
        else if (word == "kitti")
            formats.kitti = true;
        else if (word == "kitti-tracking")
            formats.kitti_tracking = true;
        else
            throw std::invalid_argument("--format " + word +
                                        ": must be csv, kitti, kitti-tracking or jsonl, or several of them");
    }
    return formats;
}

Exports::Exports(fs::path folder, const ExportFormats& formats) {
    removeOld(folder, formats);
    if (formats.csv) csv_.emplace(folder / "obstacles.csv").append(csvHeader());
    if (formats.jsonl) jsonl_.emplace(folder / "obstacles.jsonl");
    if (formats.kitti_tracking) tracks_.emplace(folder / "kitti_tracking.txt");
    if (formats.zones) zones_.emplace(folder / "zones.csv").append(zonesCsvHeader());
    if (formats.poses)
        poses_.emplace(folder / "matched_poses.csv").append("scan_index,timestamp,x,y,z,roll,pitch,yaw,frame\n");
    if (!formats.kitti) return;
    kitti_ = folder / "kitti";
    std::error_code error;
    fs::create_directories(kitti_, error);
    if (error) throw std::runtime_error(kitti_.string() + ": cannot make the folder: " + error.message());
}

void Exports::add(double timestamp, std::size_t scan_index, const std::vector<Obstacle>& obstacles,
                  const JsonExtras& extras) {
    if (csv_) csv_->append(csvRows(timestamp, scan_index, obstacles));
    if (jsonl_) jsonl_->append(jsonLine(timestamp, scan_index, obstacles, extras));
    if (zones_ && extras.zones != nullptr) zones_->append(zonesCsvRows(timestamp, scan_index, *extras.zones));
    if (tracks_) tracks_->append(kittiTrackingLines(scan_index, obstacles));
    if (kitti_.empty()) return;
    char name[32];
    std::snprintf(name, sizeof name, "%06zu.txt", scan_index);
    writeTextFile(kitti_ / name, kittiLines(obstacles));
}

void Exports::addPose(double timestamp, std::size_t scan_index, const Eigen::Isometry3d& pose, std::size_t frame) {
    if (!poses_) return;
    const Eigen::Matrix3d R = pose.linear();
    std::string row = std::to_string(scan_index) + ',' + fixedText(timestamp, 6);
    for (int axis = 0; axis < 3; ++axis) row += ',' + fixedText(pose.translation()[axis], 4);
    for (const double angle :
         {std::atan2(R(2, 1), R(2, 2)), -std::asin(std::clamp(R(2, 0), -1.0, 1.0)), std::atan2(R(1, 0), R(0, 0))})
        row += ',' + fixedText(angle, 6);
    poses_->append(row + ',' + std::to_string(frame) + '\n');
}

void Exports::close() {
    for (auto* file : {&poses_, &csv_, &jsonl_, &tracks_, &zones_})
        if (*file) (*file)->close();
}

void Exports::discard() {
    for (auto* file : {&poses_, &csv_, &jsonl_, &tracks_, &zones_})
        if (*file) (*file)->discard();
}

}  // namespace lidar_obstacles::apps
