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
          index_(&cloud.view.index[static_cast<std::size_t>(ring) * cloud.view.columns]) {}

    std::int32_t at(int column) const { return index_[wrapped(column)]; }
    bool has(int column) const { return at(column) >= 0; }
    bool isGround(int column) const { return isGroundReturn(at(column)); }
    bool isGroundReturn(std::int32_t i) const { return model_.is_ground[i] != 0; }
    /// Is any of its returns labelled ground?
    bool meetsGround() const {
        return std::any_of(index_, index_ + columns,
                           [this](std::int32_t i) { return i >= 0 && model_.is_ground[i] != 0; });
    }
    /// Are both returns ground, without a step in between?
    bool goesOn(std::int32_t i, std::int32_t other) const {
        return isGroundReturn(i) && isGroundReturn(other) && std::abs(step(i, other)) <= kSmooth;
    }

    /// How much higher above the plane of the scan a return is than another [m]. Not above the surface: a car that a
    /// single ring meets lifts that below itself.
    float step(std::int32_t i, std::int32_t other) const {
        const Eigen::Vector3f apart = cloud_.xyz[i] - cloud_.xyz[other];
        return apart.z() - model_.plane.slope.cast<float>().dot(apart.head<2>());
    }

    int columns;

  private:
    /// The column within 0 .. columns - 1.
    int wrapped(int column) const {
        while (column >= columns) column -= columns;
        while (column < 0) column += columns;
        return column;
    }
    const PointCloud& cloud_;
    const GroundModel& model_;
    const std::int32_t* index_;
};

}  // namespace lidar_obstacles
