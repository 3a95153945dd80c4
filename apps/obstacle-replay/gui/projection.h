// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where things of the scene are on the screen, and what lies under a place of the screen. No window.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "lidar_obstacles/obstacle.h"

namespace lidar_obstacles::apps {

/// Where the window's camera is: `distance` away from what it looks at, in MRPT's angles.
struct CameraPlace {
    float x = 0, y = 0, z = 0;  ///< looks at, vehicle frame [m]
    float azimuth_deg = 0;      ///< where the camera is, seen from there
    float elevation_deg = 0;
    float distance = 0;  ///< [m]
};

/// A part of the window [pixels], from its top left corner.
struct ScreenRect {
    float x = 0, y = 0, width = 0, height = 0;

    bool holds(float px, float py) const { return px >= x && px < x + width && py >= y && py < y + height; }
    bool meets(const ScreenRect& o) const {
        return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
    }
};

/// The camera of a scene that is drawn into a part of the window; 30 degrees from its lower to its upper edge, as MRPT
/// has it.
class Projection {
  public:
    Projection(const CameraPlace& camera, const ScreenRect& scene);

    /// The pixel of a point; none behind the camera. It may lie outside of the scene's part of the window.
    std::optional<Eigen::Vector2f> pixelOf(const Eigen::Vector3d& point) const;
    /// The direction of what is seen at a pixel, unit length.
    Eigen::Vector3d rayThrough(float x, float y) const;
    const Eigen::Vector3d& eye() const { return eye_; }

  private:
    ScreenRect scene_;
    Eigen::Vector3d eye_, ahead_, right_, up_;
    double scale_;  ///< pixels per tangent
};

/// The obstacle whose box is seen at a pixel, of several the nearest to the camera; where there is none the one whose
/// middle is within 12 pixels. Its place in the list; none where there is nothing.
std::optional<std::size_t> obstacleAt(const std::vector<Obstacle>& obstacles, const Projection& projection, float x,
                                      float y);

}  // namespace lidar_obstacles::apps
