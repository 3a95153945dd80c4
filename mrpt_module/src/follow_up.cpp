#include "follow_up.h"

namespace lidar_obstacles {

float followUp(const PointCloud& cloud, const GroundModel& ground, std::int32_t start) {
    const OrganizedView& view = cloud.view;
    std::int32_t i = start;
    for (int ring = cloud.ring[start] + 1; ring < view.rings; ++ring) {
        const std::int32_t j = view.at(ring, view.column_of[start]);
        if (j < 0) continue;
        const float run = (cloud.xyz[j].head<2>() - cloud.xyz[i].head<2>()).norm();
        const float rise = ground.height[j] - ground.height[i];
        if (run > 0.25f + 0.25f * rise) break;
        i = j;
    }
    return ground.height[i];
}

}  // namespace lidar_obstacles
