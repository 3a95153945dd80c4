// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The obstacles of a run, in the formats that were asked for.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/obstacles_json.h"
#include "common/text_file.h"
#include "exports/mcap_writer.h"
#include "exports/scan_output.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

struct ExportFormats {
    bool csv = true;              ///< obstacles.csv
    bool jsonl = false;           ///< obstacles.jsonl: one line per scan
    bool kitti = false;           ///< kitti/NNNNNN.txt: one label file per scan
    bool kitti_tracking = false;  ///< kitti_tracking.txt: the tracks of all scans
    bool zones = false;           ///< zones.csv
    bool low = false;             ///< low_things.csv: steps, drops and missing ground
    bool mcap = false;            ///< obstacles.mcap: all of it, for Foxglove
    bool ply = false;             ///< ply/NNNNNN.ply: points and boxes, one file per scan
    bool poses = false;           ///< matched_poses.csv: poses of the vehicle, as obstacle-track reads them
    bool replace = false;         ///< an earlier run wrote into this folder: its files per scan go
};

/// "csv,jsonl,kitti,kitti-tracking,mcap,ply", any of them. @throws std::invalid_argument naming the word that is none.
ExportFormats parseFormats(const std::vector<std::string>& words);

/// Files in the output folder. All functions throw std::runtime_error that names the file if it cannot be written.
class Exports {
  public:
    /// Takes away what an earlier run left of all formats.
    /// @param metadata  of the run: what a file says of itself where its format has a place for that.
    Exports(const std::filesystem::path& folder, const ExportFormats& formats,
            const std::map<std::string, std::string>& metadata);

    /// One scan; with its zones for zones.csv where that is wanted.
    void add(const ScanOutput& scan, const JsonExtras& extras);
    /// A pose for matched_poses.csv, if that is wanted. @param frame  counts the frames: poses of two have nothing in
    /// common.
    void addPose(double timestamp, std::size_t scan_index, const Eigen::Isometry3d& T_world_vehicle, std::size_t frame);
    void close();
    /// Takes the files away: the run was wrong from the start.
    void discard();

  private:
    std::filesystem::path kitti_;  ///< folder; empty: not asked for
    std::filesystem::path ply_;    ///< likewise
    std::optional<TextFile> csv_;
    std::optional<TextFile> jsonl_;
    std::optional<TextFile> tracks_;
    std::optional<TextFile> poses_;
    std::optional<TextFile> zones_;
    std::optional<TextFile> low_;
    std::optional<McapWriter> mcap_;
};

}  // namespace lidar_obstacles::apps
