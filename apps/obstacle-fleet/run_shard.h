// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The work of one shard.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "manifest.h"
#include "shard.h"

namespace lidar_obstacles::fleet {

struct RunOptions {
    std::filesystem::path manifest;
    std::filesystem::path output = "output/fleet";
    std::string shard;          ///< "I/N"; "": see chooseShard()
    bool retry_failed = false;  ///< also what the recordings themselves are to blame for
    bool wait = true;           ///< for work of this shard that another process is at
    double stale = 300.0;       ///< claims without a sign of life for so long are void [s]
    double timeout = 0.0;       ///< for one recording [s]; 0: none
};

/// What came of a shard.
struct RunReport {
    std::size_t recordings = 0;  ///< in the shard
    std::size_t done = 0;        ///< by this process
    std::size_t before = 0;      ///< done before, or by others meanwhile
    std::size_t failed = 0;      ///< of all of these, those that failed or are damaged
    std::size_t left = 0;        ///< others are at them still, or the run was interrupted
};

/// Does what is not done yet of a shard: claim, work in a process of its own, publish, release. Prints a line for each
/// recording. What others are at is waited for, and done if they die.
/// @throws std::runtime_error if the manifest or the output folder cannot be used, or results cannot be written.
RunReport runShard(const RunOptions& options);

}  // namespace lidar_obstacles::fleet
