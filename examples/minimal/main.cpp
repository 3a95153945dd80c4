// SPDX-License-Identifier: BSD-3-Clause
// Prints the boxes in every scan of a rawlog or a Velodyne capture.
#include <lidar_obstacles/mrpt_bridge/observations.h>
#include <lidar_obstacles/mrpt_bridge/scan_source.h>
#include <lidar_obstacles/pipelines.h>

#include <cstdio>
#include <stdexcept>

using namespace lidar_obstacles;

int main(int argc, char** argv) try {
    if (argc != 2) throw std::invalid_argument("usage: minimal FILE.rawlog");
    const DetectorParams params;  // the defaults; from a file: loadParams("config.ini"), mrpt_bridge/config_file.h
    const auto source = openScanSource(argv[1]);
    while (const auto item = source->next()) {
        const auto cloud = item->observation ? toPointCloud(*item->observation, params.sensor) : std::nullopt;
        if (!cloud) continue;  // no lidar's: a pose, an image ...
        for (const Obstacle& o : detect(*cloud, params).obstacles)
            std::printf("%s at %.1f, %.1f m, %.1f x %.1f x %.1f m\n", toString(o.cls), o.box.center.x(),
                        o.box.center.y(), o.box.size.x(), o.box.size.y(), o.box.size.z());
    }
    if (source->status() == SourceStatus::Damaged) throw std::runtime_error(source->message());
} catch (const std::exception& e) {
    std::fprintf(stderr, "minimal: %s\n", e.what());
    return 1;
}
