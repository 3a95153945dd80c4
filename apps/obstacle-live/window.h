// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// An optional window with what was found last.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/zones.h"
#include "look.h"

namespace lidar_obstacles::apps {

/// Draws in a thread of its own, so that it can be used between scans. It has what the window of obstacle-replay has,
/// but for the timeline and the outlines.
class Window {
  public:
    /// @param params  that scans are processed with.
    /// @param look    at the start: keys change it.
    /// @throws std::runtime_error if there is no display, or the tool was built without windows.
    Window(const DetectorParams& params, const Look& look);
    ~Window();

    /// The scan with what was found in it; a copy of it.
    /// @param params  in use; what was changed in the window and not answered yet stays as it is there.
    /// @param zones   null: there are none.
    void show(const SequenceResult& found, const ObstacleDetector& detector, const DetectorParams& params,
              const ZoneMonitor* zones);
    /// What was changed in the window since the last call, "section.key=value" each: to be done, and answered.
    std::vector<std::string> takeAssignments();
    /// @param params   in use from now on.
    /// @param refusal  why they are not those that were asked for; empty: they are.
    void answer(const DetectorParams& params, const std::string& refusal);
    /// False once the user closed it.
    bool isOpen() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lidar_obstacles::apps
