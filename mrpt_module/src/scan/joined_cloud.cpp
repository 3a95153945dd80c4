// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/joined_cloud.h"

#include <algorithm>
#include <utility>

#include "scan/organize.h"

namespace lidar_obstacles {
namespace {

/// Behind the returns and rings of the sensors before it.
void append(const PointCloud& cloud, PointCloud& joined) {
    const int first_ring = joined.view.rings;
    const auto later = static_cast<float>(cloud.timestamp - joined.timestamp);
    joined.view.rings += cloud.view.rings;
    joined.view.index.resize(static_cast<std::size_t>(joined.view.rings) * joined.view.columns, -1);
    for (std::size_t k = 0; k < cloud.size(); ++k) {
        const auto i = static_cast<std::int32_t>(joined.size());
        joined.xyz.push_back(cloud.xyz[k]);
        joined.ring.push_back(static_cast<std::uint16_t>(first_ring + cloud.ring[k]));
        joined.time_offset.push_back(later + (cloud.time_offset.empty() ? 0.0f : cloud.time_offset[k]));
        joined.view.column_of.push_back(columnOf(cloud.xyz[k] - cloud.sensor_origin, joined.view.columns));
        listNearest(i, cloud.sensor_origin, joined);
    }
    joined.intensity.insert(joined.intensity.end(), cloud.intensity.begin(), cloud.intensity.end());
    joined.sensors.push_back({cloud.sensor_origin, cloud.sensor_up, static_cast<std::int32_t>(joined.size()),
                              joined.view.rings, first_ring});
}

}  // namespace

PointCloud joinedCloud(std::vector<PointCloud> clouds) {
    if (clouds.empty()) return {};
    if (clouds.size() == 1) return std::move(clouds.front());
    PointCloud joined;
    joined.timestamp = clouds.front().timestamp;
    for (const PointCloud& cloud : clouds) {
        joined.view.columns = std::max(joined.view.columns, cloud.view.columns);
        joined.sensor_origin += cloud.sensor_origin / static_cast<float>(clouds.size());
    }
    if (joined.view.columns == 0) joined.view.columns = kUsualColumns;
    for (PointCloud& cloud : clouds) append(facingUp(std::move(cloud)), joined);
    if (joined.intensity.size() != joined.size()) joined.intensity.clear();  // not all of them tell
    return joined;
}

std::size_t sensorThatSaw(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    if (cloud.sensors.empty()) return 0;
    std::vector<std::size_t> returns(cloud.sensors.size(), 0);
    for (const std::int32_t i : points) ++returns[cloud.sensorOf(i)];
    return static_cast<std::size_t>(std::max_element(returns.begin(), returns.end()) - returns.begin());
}

}  // namespace lidar_obstacles
