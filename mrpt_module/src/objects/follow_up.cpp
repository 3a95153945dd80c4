// SPDX-License-Identifier: BSD-3-Clause
#include "objects/follow_up.h"

#include <limits>

namespace lidar_obstacles {

float SurfaceTops::operator()(std::int32_t i) {
    constexpr float kUnknown = std::numeric_limits<float>::lowest();
    if (top_.empty()) top_.assign(cloud.size(), kUnknown);
    if (top_[i] != kUnknown) return top_[i];
    top_[i] = ground.height[i];
    const OrganizedView& view = cloud.view;
    const int end = cloud.endRing(cloud.ring[i]);
    for (int ring = cloud.ring[i] + 1; ring < end; ++ring) {
        const std::int32_t j = view.at(ring, view.column_of[i]);
        if (j < 0) continue;
        const float limit = 0.25f + 0.25f * (ground.height[j] - ground.height[i]);  // of the run over the rise
        const float run_squared = (cloud.xyz[j].head<2>() - cloud.xyz[i].head<2>()).squaredNorm();
        if (limit > 0.0f && run_squared <= limit * limit) top_[i] = (*this)(j);
        break;
    }
    return top_[i];
}

}  // namespace lidar_obstacles
