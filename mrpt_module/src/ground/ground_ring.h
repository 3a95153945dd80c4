// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// One ring of the scan: its returns by column, and what the ground model says of them. Columns go around the circle:
/// -1 is the last one, and `columns` is the first again.
class GroundRing {
  public:
    static constexpr float kSmooth = 0.12f;  ///< between neighbouring returns of one run [m]
    static constexpr int kGap = 6;           ///< columns without a return that a run may skip

    /// @param cloud  with a view; it and the model must outlive the ring.
    GroundRing(const PointCloud& cloud, const GroundModel& model, int ring)
        : columns(cloud.view.columns),
          cloud_(cloud),
          model_(model),
          index_(&cloud.view.index[static_cast<std::size_t>(ring) * cloud.view.columns]),
          origin_(cloud.originOfRing(ring)),
          sensor_height_(origin_.z() - groundAt(origin_.head<2>())) {}

    /// The column within 0 .. columns - 1.
    int wrapped(int column) const {
        while (column >= columns) column -= columns;
        while (column < 0) column += columns;
        return column;
    }
    std::int32_t at(int column) const { return index_[wrapped(column)]; }
    bool has(int column) const { return at(column) >= 0; }
    bool isGround(int column) const { return isGroundReturn(at(column)); }
    bool isGroundReturn(std::int32_t i) const { return model_.is_ground[i] != 0; }
    /// Is any of its returns labelled ground?
    bool meetsGround() const {
        return std::any_of(index_, index_ + columns,
                           [this](std::int32_t i) { return i >= 0 && model_.is_ground[i] != 0; });
    }
    const Eigen::Vector3f& point(int column) const { return cloud_.xyz[at(column)]; }
    /// Are both returns ground, without a step in between?
    bool goesOn(std::int32_t i, std::int32_t other) const {
        return isGroundReturn(i) && isGroundReturn(other) && std::abs(step(i, other)) <= kSmooth;
    }

    /// How much higher above the ground a return is than another [m]. Where the planes of two sectors meet, heights
    /// jump and the ground does not: there the lesser of what either sector says.
    float step(std::int32_t i, std::int32_t other) const {
        const float step = model_.height[i] - model_.height[other];
        if (std::abs(step) <= kSmooth) return step;
        const float here = model_.height[i] - heightInSectorOf(i, other);
        const float there = heightInSectorOf(other, i) - model_.height[other];
        return std::abs(here) < std::abs(there) ? here : there;
    }
    /// Squared length of the beam of a return [m^2].
    float squaredLength(std::int32_t i) const { return (cloud_.xyz[i] - origin_).squaredNorm(); }
    /// Up to which ratio of their squared lengths two beams end level: beams of a ring come down evenly from the
    /// sensor, so that heights that differ by a step [m] go with lengths that differ by its share of the sensor's
    /// height.
    float levelRatio(float step) const {
        const float share = 1.0f + step / std::max(sensor_height_, 0.1f);
        return share * share;
    }

    int columns;

  private:
    float groundAt(const Eigen::Vector2f& p) const { return static_cast<float>(model_.heightAt(p.x(), p.y())); }
    /// Height of the return `other` above the ground as far away in the direction of return i.
    float heightInSectorOf(std::int32_t i, std::int32_t other) const {
        const Eigen::Vector2f center = model_.center.cast<float>();
        const Eigen::Vector2f here = cloud_.xyz[i].head<2>() - center;
        const float range = (cloud_.xyz[other].head<2>() - center).norm();
        return cloud_.xyz[other].z() - groundAt(center + here * (range / std::max(here.norm(), 1e-3f)));
    }

    const PointCloud& cloud_;
    const GroundModel& model_;
    const std::int32_t* index_;
    Eigen::Vector3f origin_;  ///< of its rays [m]
    float sensor_height_;     ///< above the ground [m]
};

}  // namespace lidar_obstacles
