// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of obstacle-fleet.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "merge.h"
#include "run_shard.h"

namespace lidar_obstacles::fleet {

struct ManifestOptions {
    std::vector<std::string> inputs;  ///< recordings and folders
    std::string list;                 ///< file with more of them; "": none
    std::string output = "manifest.jsonl";
    std::string config;  ///< empty: the built-in defaults
    std::vector<std::string> set;
    std::vector<std::string> known;          ///< earlier manifests
    std::vector<std::string> input_options;  ///< words
    bool rehash = false;                     ///< also what `output` knows already
    int threads = 1;
};

struct Options {
    enum class Command : std::uint8_t { Manifest, Run, Merge };
    Command command = Command::Manifest;
    ManifestOptions manifest;
    RunOptions run;
    MergeOptions merge;
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then.
/// @throws apps::UsageError
std::optional<Options> parseOptions(int argc, char** argv);

}  // namespace lidar_obstacles::fleet
