// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the beams of one scan prove: which returns are neighbours, how rough a surface is, and where beams passed.
#pragma once

#include <cstdint>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// A scan seen as beams, each from the origin of its sensor.
///
/// One model gives all tolerances: beams are `azimuthStep()` apart along a ring and `stepUp()`, `stepDown()` from ring
/// to ring, and ranges are off by `noise()`.
/// Its const members may be called by several threads at a time.
class Beams {
  public:
    /// Estimates the noise from the scan's own smooth surfaces.
    ///
    /// @param cloud  must outlive this. Without a view (sources without rings) no beam has neighbours.
    explicit Beams(const PointCloud& cloud);

    const PointCloud& cloud() const { return cloud_; }
    /// Horizontal distance of a return from its sensor [m].
    float range(std::int32_t i) const { return range_[i]; }
    /// Height of the beam of return i at a horizontal distance from the sensor, in the frame of the cloud [m].
    float beamHeight(std::int32_t i, float at) const {
        const float origin = cloud_.originOf(i).z();
        return origin + (cloud_.xyz[i].z() - origin) * at / (range_[i] > 0.01f ? range_[i] : 0.01f);
    }
    /// Angle between neighbouring beams of a ring [rad].
    float azimuthStep() const { return azimuth_step_; }
    /// Angle from a ring to the next one of its sensor up or down [rad]; infinite where there is none.
    float stepUp(int ring) const { return step_[ring + 1]; }
    float stepDown(int ring) const { return step_[ring]; }
    /// Standard deviation of the ranges [m], from a quarter of the scan that is smoothest.
    float noise() const { return noise_; }
    int ring(std::int32_t i) const { return cloud_.ring.empty() ? 0 : cloud_.ring[i]; }
    int column(std::int32_t i) const { return cloud_.view.column_of[i]; }

    /// The neighbouring return on the same ring (step +1 or -1), across at most two missing beams; -1: none.
    std::int32_t beside(std::int32_t i, int step) const;
    /// Distance of a return to the line between its two neighbours of the same ring, seen from above [m]; negative
    /// where it does not have two on one surface.
    float roughness(std::int32_t i) const;

  private:
    void estimateNoise();

    const PointCloud& cloud_;
    std::vector<float> range_;
    std::vector<float> step_;  ///< from the ring below to each ring [rad]
    float azimuth_step_;
    float noise_;
};

}  // namespace lidar_obstacles
