/// @file
/// An optional window with what was found last.
#pragma once

#include <memory>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

class Window {
  public:
    /// @throws std::runtime_error if there is no display, or the tool was built without MRPT's gui library.
    Window();
    ~Window();

    void show(const PointCloud& cloud, const DetectionResult& result);
    /// False once the user closed it.
    bool isOpen() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lidar_obstacles::apps
