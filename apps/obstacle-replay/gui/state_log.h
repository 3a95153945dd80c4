/// @file
/// What the window shows, as JSON lines: for tests and measurements.
#pragma once

#include <fstream>
#include <string>

#include "controls.h"
#include "display_window.h"
#include "player.h"

namespace lidar_obstacles::apps {

/// Writes a line whenever what is shown has changed.
class StateLog {
  public:
    /// @param file  empty: nothing is written. @throws std::runtime_error if it cannot be written.
    explicit StateLog(const std::string& file);

    void write(const Player& player, const ViewState& view, const SceneLayers& layers, const DisplayWindow& window);

  private:
    std::ofstream out_;
    std::string last_;
};

}  // namespace lidar_obstacles::apps
