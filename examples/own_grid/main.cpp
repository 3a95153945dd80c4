// SPDX-License-Identifier: BSD-3-Clause
// Boxes from a grid map of your own: any COccupancyGridMap2D in the vehicle frame, and the scan that belongs to it.
#include <lidar_obstacles/mrpt_bridge/maps.h>
#include <lidar_obstacles/mrpt_bridge/observations.h>
#include <lidar_obstacles/mrpt_bridge/scan_source.h>

#include <cstdio>
#include <stdexcept>

using namespace lidar_obstacles;

// In the place of a mapper: cells with a return 0.4 to 2 m above the vehicle's origin are occupied.
mrpt::maps::COccupancyGridMap2D mapOf(const PointCloud& cloud) {
    mrpt::maps::COccupancyGridMap2D map(-30.0F, 30.0F, -30.0F, 30.0F, 0.2F);
    for (const Eigen::Vector3f& p : cloud.xyz)
        if (p.z() > 0.4F && p.z() < 2.0F) map.setCell(map.x2idx(p.x()), map.y2idx(p.y()), 0.0F);  // of being free
    return map;
}

int main(int argc, char** argv) try {
    if (argc != 2) throw std::invalid_argument("usage: own_grid FILE.rawlog");
    const DetectorParams params;
    const auto source = openScanSource(argv[1]);
    while (const auto item = source->next()) {
        const auto cloud = item->observation ? toPointCloud(*item->observation, params.sensor) : std::nullopt;
        if (!cloud) continue;  // no lidar's
        // std::nullopt: the ground is found in the scan.
        for (const Obstacle& o : detectOnGrid(mapOf(*cloud), *cloud, std::nullopt, params).obstacles)
            std::printf("%s at %.1f, %.1f m\n", toString(o.cls), o.box.center.x(), o.box.center.y());
    }
    if (source->status() == SourceStatus::Damaged) throw std::runtime_error(source->message());
} catch (const std::exception& e) {
    std::fprintf(stderr, "own_grid: %s\n", e.what());
    return 1;
}
