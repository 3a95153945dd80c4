// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of obstacle-replay.
#pragma once

#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/class_choice.h"
#include "common/input_choice.h"
#include "exports.h"
#include "gui/view_options.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {

/// Which of the processed scans a kind of file is written for.
struct Selection {
    int every = 0;  ///< 0: none; k: the first and every k-th after it

    bool has(std::size_t processed) const { return every > 0 && processed % static_cast<std::size_t>(every) == 0; }
};

struct Options {
    std::string input;
    std::string config;  ///< empty: the built-in defaults
    std::string output = "output";
    InputChoice choice;
    std::optional<int> planes;
    int from = 0;                              ///< first scan_index
    int to = std::numeric_limits<int>::max();  ///< last scan_index
    int every = 1;                             ///< from `from` on
    std::vector<std::string> set;              ///< section.key=value
    ExportFormats formats;
    ClassChoice classes;
    std::string zones;     ///< file of zones; empty: none
    std::string annotate;  ///< rawlog to write; empty: none
    std::string report;    ///< HTML file to write; empty: none
    Selection scenes;
    Selection grids;
    Selection pictures;
    CameraView view;              ///< of the pictures
    bool explain = false;         ///< scenes and pictures show where each box comes from
    bool learn_own_body = false;  ///< of what stays in place around the vehicle
    bool print_config = false;
    ViewOptions show;
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then.
/// @throws UsageError
std::optional<Options> parseOptions(int argc, char** argv);

}  // namespace lidar_obstacles::apps
