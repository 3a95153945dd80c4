// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

constexpr int kColumnsOfPacket = 24;  ///< the firings of a packet of a VLP-16

/// The columns of a view without those where nobody looked: where a packet is missing, and at the seam of the turn, if
/// it is cut between packets. What is on both sides of such a hole is next to each other.
///
/// A hole is a stretch of at most kColumnsOfPacket columns in which no ring brought anything back. Longer ones
/// are the limits of what the sensor looks at, and where more than a quarter of the rest is empty, the scan has no
/// ground that says where somebody looked: these stay. Of several sensors the holes of one are columns of the others,
/// which stay too.
class LookedColumns {
  public:
    /// @param view  may be empty: no columns.
    explicit LookedColumns(const OrganizedView& view);

    int count() const { return static_cast<int>(column_.size()); }
    /// Place among the columns that stay; of one in a hole: that of the last one before it.
    int placeOf(int column) const { return place_[static_cast<std::size_t>(column)]; }
    /// Column of the view; places go round.
    int columnAt(int place) const {
        const int n = count();
        if (place < 0 || place >= n) place = (place % n + n) % n;
        return column_[static_cast<std::size_t>(place)];
    }

  private:
    std::vector<int> place_;
    std::vector<int> column_;
};

}  // namespace lidar_obstacles
