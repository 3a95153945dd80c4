/// @file
/// An optional window with what was found last.
#pragma once

#include <memory>

#include "lidar_obstacles/detector.h"

namespace lidar_obstacles::apps {

class Window {
  public:
    /// @throws std::runtime_error if there is no display, or the tool was built without MRPT's gui library.
    Window();
    ~Window();

    /// Points and boxes, and what the 3D filter knows and took out.
    void show(const SequenceResult& found, const ObstacleDetector& detector);
    /// False once the user closed it.
    bool isOpen() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lidar_obstacles::apps
