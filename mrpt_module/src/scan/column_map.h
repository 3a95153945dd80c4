// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Which column of a scan's view looks in a direction, by the directions of some of its returns. Good to a column or
/// two where the sensor stands level.
class ColumnMap {
  public:
    /// @param cloud  with a view and at least one return.
    explicit ColumnMap(const PointCloud& cloud);

    /// Column of the direction with this azimuth, counter-clockwise from +x [rad].
    int columnOf(double azimuth) const;
    /// Of the columns: -1 clockwise, +1 counter-clockwise.
    int sense() const { return sense_; }

  private:
    int columns_;
    int sense_ = -1;
    double zero_ = 0.0;  ///< column at azimuth 0
};

}  // namespace lidar_obstacles
