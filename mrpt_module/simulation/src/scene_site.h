// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which room is taken in a scene that is being drawn, and at what time.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lidar_obstacles::simulation {

/// A box that stands upright. World frame.
struct Footprint {
    Eigen::Vector2d center;
    Eigen::Vector2d half;
    double yaw = 0.0;
    double bottom = 0.0, top = 0.0;  ///< above the ground
};

/// True if two boxes come nearer to each other than `margin`, seen from above, at any height that both have.
bool meet(const Footprint& a, const Footprint& b, double margin);

/// The room of a part of a thing: once if it stands, or at each of the times of the site.
using Room = std::vector<Footprint>;

class Site {
  public:
    /// True if nothing that was added comes nearer than `margin` at any time.
    bool isFree(const std::vector<Room>& parts, double margin) const;
    void add(const std::vector<Room>& parts);

  private:
    struct Taken {
        Room room;
        Eigen::Vector2d center;  ///< of a circle about it at all times
        double radius;
    };
    static Taken circled(const Room& room);

    std::vector<Taken> taken_;
};

}  // namespace lidar_obstacles::simulation
