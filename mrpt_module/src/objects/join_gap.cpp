// SPDX-License-Identifier: BSD-3-Clause
#include "objects/join_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_obstacles {

Gap gapBetween(const Footprint& a, const Footprint& b) {
    const auto squared = [&](int k) -> Footprint::Numbers { return (b.x - a.x[k]).square() + (b.y - a.y[k]).square(); };
    Footprint::Numbers least = squared(0);  // from each return of b
    for (int k = 1; k < Footprint::kDirections; ++k)
        if (a.returns[k] != a.returns[k - 1]) least = least.min(squared(k));
    Eigen::Index of_b = 0;
    Eigen::Index of_a = 0;
    const float length = std::sqrt(least.minCoeff(&of_b));
    least = (a.x - b.x[of_b]).square() + (a.y - b.y[of_b]).square();
    least.minCoeff(&of_a);
    return {a.returns[of_a], b.returns[of_b], length};
}

}  // namespace lidar_obstacles
