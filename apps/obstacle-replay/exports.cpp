// SPDX-License-Identifier: BSD-3-Clause
#include "exports.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <utility>

#include "common/kitti_labels.h"
#include "common/low_rows.h"
#include "common/number_text.h"
#include "common/numbered_files.h"
#include "common/obstacles_csv.h"
#include "common/zone_rows.h"
#include "exports/foxglove.h"
#include "exports/ply.h"

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
                                       {"low_things.csv", formats.low},
                                       {"obstacles.mcap", formats.mcap},
                                       {"matched_poses.csv", formats.poses}}) {
        fs::remove(folder / name, ignored);
        if (!wanted) fs::remove(folder / (std::string(name) + ".part"), ignored);
    }
    if (!formats.replace) return;  // files of such names may be labels
    removeNumbered(folder / "kitti", {{"", ".txt"}, {"", ".txt.part"}});
    removeNumbered(folder / "ply", {{"", ".ply"}, {"", ".ply.part"}});
}

void makeFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw std::runtime_error(folder.string() + ": cannot make the folder: " + error.message());
}

/// The file of one scan in a folder.
fs::path numberedFile(const fs::path& folder, std::size_t scan_index, const char* extension) {
    char name[32];
    std::snprintf(name, sizeof name, "%06zu", scan_index);
    return folder / (std::string(name) + extension);
}

}  // namespace

ExportFormats parseFormats(const std::vector<std::string>& words) {
    ExportFormats formats;
    formats.csv = false;
    const std::map<std::string, bool*> known = {{"csv", &formats.csv},     {"jsonl", &formats.jsonl},
                                                {"kitti", &formats.kitti}, {"kitti-tracking", &formats.kitti_tracking},
                                                {"mcap", &formats.mcap},   {"ply", &formats.ply}};
    for (const std::string& word : words) {
        const auto format = known.find(word);
        if (format == known.end())
            throw std::invalid_argument("--format " + word +
                                        ": must be csv, jsonl, kitti, kitti-tracking, mcap or ply, " +
                                        "or several of them");
        *format->second = true;
    }
    return formats;
}

Exports::Exports(const fs::path& folder, const ExportFormats& formats,
                 const std::map<std::string, std::string>& metadata) {
    removeOld(folder, formats);
    if (formats.csv) csv_.emplace(folder / "obstacles.csv").append(csvHeader());
    if (formats.jsonl) jsonl_.emplace(folder / "obstacles.jsonl");
    if (formats.kitti_tracking) tracks_.emplace(folder / "kitti_tracking.txt");
    if (formats.zones) zones_.emplace(folder / "zones.csv").append(zonesCsvHeader());
    if (formats.low) low_.emplace(folder / "low_things.csv").append(lowCsvHeader());
    if (formats.poses)
        poses_.emplace(folder / "matched_poses.csv").append("scan_index,timestamp,x,y,z,roll,pitch,yaw,frame\n");
    if (formats.mcap) mcap_.emplace(folder / "obstacles.mcap", foxgloveChannels(), metadata);
    if (formats.kitti) makeFolder(kitti_ = folder / "kitti");
    if (formats.ply) makeFolder(ply_ = folder / "ply");
}

void Exports::add(const ScanOutput& scan, const JsonExtras& extras) {
    const double timestamp = scan.found.cloud.timestamp;
    const std::vector<Obstacle>& obstacles = scan.found.detection.obstacles;
    if (csv_) csv_->append(csvRows(timestamp, scan.scan_index, obstacles));
    if (jsonl_) jsonl_->append(jsonLine(timestamp, scan.scan_index, obstacles, extras));
    if (zones_ && extras.zones != nullptr) zones_->append(zonesCsvRows(timestamp, scan.scan_index, *extras.zones));
    if (low_) low_->append(lowCsvRows(timestamp, scan.scan_index, scan.found.detection.low));
    if (mcap_) mcap_->addChunk(foxgloveMessages(scan));
    if (tracks_) tracks_->append(kittiTrackingLines(scan.scan_index, obstacles));
    if (!kitti_.empty()) writeTextFile(numberedFile(kitti_, scan.scan_index, ".txt"), kittiLines(obstacles));
    if (!ply_.empty()) writeTextFile(numberedFile(ply_, scan.scan_index, ".ply"), plyText(scan));
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
    for (auto* file : {&poses_, &csv_, &jsonl_, &tracks_, &zones_, &low_})
        if (*file) (*file)->close();
    if (mcap_) mcap_->close();
}

void Exports::discard() {
    for (auto* file : {&poses_, &csv_, &jsonl_, &tracks_, &zones_, &low_})
        if (*file) (*file)->discard();
    if (mcap_) mcap_->discard();
}

}  // namespace lidar_obstacles::apps
