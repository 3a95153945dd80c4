// SPDX-License-Identifier: BSD-3-Clause
// Tracks with their velocities over ground, by the poses of the rawlog or by your own.
#include <lidar_obstacles/detector.h>
#include <lidar_obstacles/mrpt_bridge/joined_lidars.h>
#include <lidar_obstacles/mrpt_bridge/pose_feed.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

using namespace lidar_obstacles;

int main(int argc, char** argv) try {
    if (argc != 2 && argc != 3) throw std::invalid_argument("usage: odometry FILE.rawlog [POSES.txt]");
    ObstacleDetector detector{DetectorParams{}};
    EgoSource recorded;
    if (argc == 2) {
        recorded = chooseEgoSource(argv[1], "auto");  // the best there is; or the label of the one to take
        if (recorded.kind == EgoKind::None) throw std::runtime_error(std::string(argv[1]) + ": holds no poses");
    } else {  // a program adds each pose as soon as it knows it
        std::ifstream file(argv[2]);
        for (double time, x, y, yaw; file >> time >> x >> y >> yaw;)
            detector.addPose(toStampedPose(time, mrpt::poses::CPose3D(x, y, 0.0, yaw, 0.0, 0.0)));
        if (!file.eof()) throw std::runtime_error(std::string(argv[2]) + ": cannot be read as lines of time x y yaw");
    }
    const auto source = openScanSource(argv[1]);
    PoseFeed feed(*source, recorded, [&detector](const StampedPose& pose) { detector.addPose(pose); });
    while (const auto item = feed.next()) {
        if (!item->observation || !isLidarScan(*item->observation)) continue;
        for (const Obstacle& o : detector.process(toPointCloud(*item, SensorParams{})).detection.obstacles)
            if (o.track && o.track->velocity)
                std::printf("%s %d at %.1f, %.1f m: %.1f m/s\n", toString(o.cls), o.id, o.box.center.x(),
                            o.box.center.y(), o.track->velocity->norm());
    }
    if (feed.status() == SourceStatus::Damaged) throw std::runtime_error(feed.message());
} catch (const std::exception& e) {
    std::fprintf(stderr, "odometry: %s\n", e.what());
    return 1;
}
