// SPDX-License-Identifier: BSD-3-Clause
// Two lidars or more as one: their scans of the same time become one cloud, by the place of each on the vehicle.
#include <lidar_obstacles/joined_cloud.h>
#include <lidar_obstacles/mrpt_bridge/joined_lidars.h>
#include <lidar_obstacles/pipelines.h>

#include <cstdio>
#include <stdexcept>

using namespace lidar_obstacles;

int main(int argc, char** argv) try {
    if (argc != 2 && argc != 3) throw std::invalid_argument("usage: two_lidars FILE.rawlog [LABEL,LABEL...]");
    const DetectorParams params;
    JoinedLidars source(openScanSource(argv[1]), argc == 3 ? argv[2] : "all");
    int joined = 0;
    while (const auto item = source.next()) {
        if (item->beside.empty()) continue;  // no scan, or one without another beside it
        ++joined;
        const PointCloud cloud = toPointCloud(*item, params.sensor);  // with clouds of your own: joinedCloud({a, b})
        for (const Obstacle& o : detect(cloud, params).obstacles)
            std::printf("%s at %.1f, %.1f m, seen best by lidar %zu\n", toString(o.cls), o.box.center.x(),
                        o.box.center.y(), sensorThatSaw(o.points, cloud));
    }
    if (source.status() == SourceStatus::Damaged) throw std::runtime_error(source.message());
    if (joined == 0) throw std::runtime_error(std::string(argv[1]) + ": no two lidars have scans of the same time");
} catch (const std::exception& e) {
    std::fprintf(stderr, "two_lidars: %s\n", e.what());
    return 1;
}
