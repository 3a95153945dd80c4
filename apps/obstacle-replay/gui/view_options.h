// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The options of obstacle-replay that are about windows and videos.
#pragma once

#include <string>

#include "common/run_app.h"
#include "lidar_obstacles/mrpt_bridge/scene_layers.h"
#include "look.h"

namespace CLI {
class App;
}

namespace lidar_obstacles::apps {

struct ViewOptions {
    bool gui = false;              ///< a window instead of results
    std::string log;               ///< what the window shows, as JSON lines; empty: none
    std::string record;            ///< folder or .mp4 file; empty: none
    std::string truth;             ///< labelled objects (*_gt.csv); empty: none
    double truth_fov_deg = 360.0;  ///< angle ahead that is labelled
    std::string layer_list;        ///< as on the command line
    std::string color_word = "height";
    std::string size_text;

    LayerSet layers = usualLayers();        ///< that are on at the start
    PointColor color = PointColor::Height;  ///< of raw returns
    Look look;                              ///< of the window
    int width = 800;                        ///< of window and video [pixels]
    int height = 600;
    int picture_width = 1280;  ///< of --pictures [pixels]
    int picture_height = 800;
};

/// Adds the options to a command line; finishViewOptions reads what was given.
void addViewOptions(CLI::App& app, ViewOptions& options);
/// @throws UsageError
void finishViewOptions(ViewOptions& options);

}  // namespace lidar_obstacles::apps
