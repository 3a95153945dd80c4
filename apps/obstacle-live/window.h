/// @file
/// An optional window with what was found last.
#pragma once

#include <memory>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/own_body.h"

namespace lidar_obstacles::apps {

class Window {
  public:
    /// @param own_body  of the vehicle, drawn beside what is found.
    /// @throws std::runtime_error if there is no display, or the tool was built without MRPT's gui library.
    explicit Window(OwnBody own_body);
    ~Window();

    /// Points and boxes, and what the 3D filter knows and took out.
    void show(const SequenceResult& found, const ObstacleDetector& detector);
    /// False once the user closed it.
    bool isOpen() const;

  private:
    struct Impl;
    OwnBody own_body_;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lidar_obstacles::apps
