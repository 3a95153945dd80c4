// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// The angles between the rings of a scan: what a ring would have met above or below one of its neighbour's returns.
class RingElevations {
  public:
    /// From the returns themselves. Rings without returns are filled in evenly between their neighbours.
    explicit RingElevations(const PointCloud& cloud);

    /// Angle to the next ring up (down) [rad]. Infinite for the highest (lowest) ring; 2 deg, the step of a VLP-16,
    /// where the source has no rings.
    float stepUp(int ring) const { return step_.empty() ? kUsual : step_[ring + 1]; }
    float stepDown(int ring) const { return step_.empty() ? kUsual : step_[ring]; }

  private:
    static constexpr float kUsual = 0.035f;  // 2 deg

    void addSensor(const PointCloud& cloud, const SensorRays& sensor, int first);

    std::vector<float> step_;  ///< from the ring below to each ring, and beyond the highest [rad]
};

}  // namespace lidar_obstacles
