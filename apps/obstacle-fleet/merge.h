// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The results of all shards as databases, and what is to be read about them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace lidar_obstacles::fleet {

struct MergeOptions {
    std::filesystem::path manifest;
    std::filesystem::path output = "output/fleet";  ///< as of the runs
    std::filesystem::path into;                     ///< for what is made; empty: `output`
    std::filesystem::path baseline;                 ///< fleet.sqlite of another run; empty: none
    bool with_obstacles = true;                     ///< rows of obstacles; false: they stay in obstacles.csv
    int replays = 10;                               ///< of the recordings that changed most, this many are replayed
    std::string replay;                             ///< obstacle-replay; empty: the one beside this program
    std::string baseline_replay;                    ///< of the baseline's version; empty: as `replay`
};

struct MergeReport {
    std::size_t recordings = 0;
    std::size_t failed = 0;   ///< or damaged
    std::size_t missing = 0;  ///< not done yet
    std::size_t rows = 0;     ///< of all tables
    std::size_t changed = 0;  ///< against the baseline
};

/// Writes fleet.sqlite (about, recordings, results, scans, obstacles, tracks, failures), timings.sqlite, failures.csv,
/// report.html and timings.html into that folder, which is made if missing; each is whole or not there. What they hold
/// follows the manifest, so that fleet.sqlite has the same bytes whatever the shards were.
/// @throws std::runtime_error naming the file that cannot be read, is not what was written, or cannot be written.
MergeReport merge(const MergeOptions& options);

}  // namespace lidar_obstacles::fleet
