// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Images of cameras on the graphics card.
#pragma once

#include <memory>

#include "camera_image.h"

namespace lidar_obstacles::apps {

/// A picture on the graphics card. To be used by the thread that draws.
class ImageTexture {
  public:
    ImageTexture() = default;
    ~ImageTexture();
    ImageTexture(const ImageTexture&) = delete;
    ImageTexture& operator=(const ImageTexture&) = delete;

    /// Copies the image there unless it is the one that is there. @return its name in OpenGL.
    unsigned show(const std::shared_ptr<const CameraImage>& image);

  private:
    unsigned name_ = 0;
    std::shared_ptr<const CameraImage> shown_;
};

}  // namespace lidar_obstacles::apps
