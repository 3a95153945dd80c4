// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the window shows, as JSON lines: for tests and measurements.
#pragma once

#include <fstream>
#include <string>

#include "controls.h"
#include "panels.h"
#include "param_list.h"
#include "player.h"
#include "survey.h"
#include "viewer.h"

namespace lidar_obstacles::apps {

/// What a window shows.
struct Shown {
    const Player& player;
    const ViewState& view;
    const Viewer& viewer;
    const Survey& survey;
    const ScreenRect& bar;  ///< of the timeline
    const DrawnParameters& parameters;
    const CameraImage* image;  ///< null: none is shown
    const OutlineEditor& outlines;
};

/// Writes a line whenever what is shown has changed.
class StateLog {
  public:
    /// @param file  empty: nothing is written. @throws std::runtime_error if it cannot be written.
    explicit StateLog(const std::string& file);

    void write(const Shown& shown);

  private:
    std::ofstream out_;
    std::string last_;
};

}  // namespace lidar_obstacles::apps
