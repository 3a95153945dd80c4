// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a run used of time and space: poses, de-skewing, 3D filter, several scans; for summary.json.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/ego_motion.h"

namespace lidar_obstacles::apps {

struct MotionSummary {
    EgoSource source;
    std::size_t poses = 0;                                  ///< taken from the source
    std::size_t refused_poses = 0;                          ///< not finite
    std::map<std::string, std::size_t> scans_by_pose;       ///< by PoseFound
    std::map<std::string, std::size_t> scans_by_deskewing;  ///< "done" or the reason why not
    std::map<std::string, std::size_t> scans_by_match;      ///< by MatchState, where poses are made of the scans
    std::vector<double> residuals, overlaps;                ///< of the scans that were matched (ScanMatch)
    std::size_t restarts = 0;                               ///< poses jumped or were lost
    std::size_t mended_scans = 0;                           ///< with a surface that the seam tore apart
    std::size_t filtered_scans = 0;
    std::size_t filtered_returns = 0;
    std::size_t most_voxels = 0;
    std::size_t multi_scans = 0;  ///< grids with earlier scans in them

    void add(const SequenceResult& found);
    /// Where the poses came from and how good they are, in one line without an end; empty where nothing used any.
    std::string text() const;
    /// What tracks do without, as no scan had a pose; empty where that is not so.
    std::string missing(const DetectorParams& params) const;
};

/// Adds the keys "ego", "deskew", "octomap" and "multi_scan_grid".
void addMotion(nlohmann::ordered_json& json, const MotionSummary& summary, const DetectorParams& params);

}  // namespace lidar_obstacles::apps
