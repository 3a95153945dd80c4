// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An optional window with what was found last.
#pragma once

#include <memory>
#include <string>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/zones.h"
#include "look.h"

namespace lidar_obstacles::apps {

/// Draws in a thread of its own, so that it can be used between scans. It has what the window of obstacle-replay has,
/// but for the timeline and the parameters.
class Window {
  public:
    /// @param params  that scans are processed with.
    /// @param look    at the start: keys change it.
    /// @throws std::runtime_error if there is no display, or the tool was built without windows.
    Window(DetectorParams params, const Look& look);
    ~Window();

    /// The scan with what was found in it; a copy of it.
    /// @param zones  null: there are none.
    void show(const SequenceResult& found, const ObstacleDetector& detector, const ZoneMonitor* zones);
    /// False once the user closed it.
    bool isOpen() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lidar_obstacles::apps
