// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Low things between the rings: what was seen twice stays for a while, as no ring meets it at every distance.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Steps and drops of earlier scans, in the world. They are forgotten after a time, and as soon as beams pass low where
/// they were. An object is for one thread at a time.
class LowMemory {
  public:
    /// @param kept  how long what is not seen any more stays [s].
    explicit LowMemory(double kept) : kept_(kept) {}

    /// Takes in what a scan found, and adds what earlier scans found and this one did not: LowThing::age is above 0.
    /// @param T_world_vehicle  seen from above.
    void update(const PointCloud& cloud, const Eigen::Isometry2d& T_world_vehicle, DetectionResult& result);
    void forget() { things_.clear(); }

  private:
    struct Kept {
        LowThing thing;  ///< world frame
        double time;     ///< of the scan that saw it last [s]
        int scans;       ///< that saw it
    };
    double kept_;
    std::vector<Kept> things_;
};

}  // namespace lidar_obstacles
