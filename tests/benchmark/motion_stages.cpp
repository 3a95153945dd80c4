// SPDX-License-Identifier: BSD-3-Clause
#include "motion_stages.h"

#include <unistd.h>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>

#include "lidar_obstacles/deskew.h"
#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/occupancy_grid.h"
#include "lidar_obstacles/scan_matching.h"
#include "lidar_obstacles/seam.h"
#include "lidar_obstacles/static_map.h"
#include "lidar_obstacles/voxel_filter.h"
#include "timed_work.h"

namespace lidar_obstacles::bench {
namespace {

constexpr double kTurn = 0.1;    // a scan takes [s]
constexpr double kSpeed = 10.0;  // [m/s]

/// Point times where the set has none: by column, as a sensor turns.
PointCloud withTimes(PointCloud cloud) {
    if (!cloud.time_offset.empty() || cloud.view.empty()) return cloud;
    for (const std::int32_t column : cloud.view.column_of)
        cloud.time_offset.push_back(static_cast<float>(kTurn * column / cloud.view.columns));
    return cloud;
}

StampedPose poseAt(double time) {
    StampedPose pose;
    pose.time = time;
    pose.position.x() = kSpeed * time;
    pose.orientation = Eigen::AngleAxisd(0.5 * time, Eigen::Vector3d::UnitZ());
    return pose;
}

/// Poses at 20 Hz from before a scan at time 0 to after its end.
Trajectory drive() {
    Trajectory trajectory;
    for (int k = -2; k <= 6; ++k) trajectory.add(poseAt(0.05 * k));
    return trajectory;
}

std::vector<std::int32_t> candidatesOf(const PointCloud& cloud) {
    const DetectorParams params;
    return cropToRegion(cloud, segmentGround(cloud, params.ground), params.region);
}

Eigen::Isometry3d isometry(const StampedPose& pose) {
    Eigen::Isometry3d T = Eigen::Isometry3d(pose.orientation);
    T.translation() = pose.position;
    return T;
}

/// A map of the scan itself, so that many of its returns are known.
std::shared_ptr<StaticMap> mapOf(const PointCloud& cloud) {
    OctomapParams params;
    params.map = (std::filesystem::temp_directory_path() / ("bench_" + std::to_string(getpid()) + ".bt")).string();
    StaticMapBuilder builder(params.resolution, params.range);
    builder.insert(cloud, Eigen::Isometry3d::Identity());
    builder.save(params.map);
    auto map = std::make_shared<StaticMap>(params);
    std::filesystem::remove(params.map);
    return map;
}

/// A vehicle that stands: the same scan, matched with itself again and again.
struct Matching {
    explicit Matching(const PointCloud& scan)
        : cloud(scan), ground(segmentGround(scan, GroundParams{})), matcher(EgoParams{}, RegionParams{}.own_body) {
        for (int k = 0; k < 20; ++k) next();  // the first two take longer
    }
    double next() {
        cloud.timestamp += kTurn;
        const double overlap = matcher.match(cloud).overlap;
        matcher.learn(ground, {});
        return overlap;
    }

    PointCloud cloud;
    GroundModel ground;
    ScanMatcher matcher;
};

}  // namespace

void addMotionStages(const DataSet& set) {
    auto cloud = std::make_shared<PointCloud>(withTimes(set.cloud));
    cloud->timestamp = 0.0;
    if (!cloud->time_offset.empty()) {
        const auto trajectory = std::make_shared<const Trajectory>(drive());
        // the copy is part of what is timed; the pipeline moves the cloud in
        add("deskew", set, [cloud, trajectory] { return deskew(*cloud, *trajectory).cloud.size(); });
        add("seam", set, [cloud] { return findSeamGap(*cloud).rings; });
    }
    const auto matching = std::make_shared<Matching>(*cloud);
    add("match", set, [matching] { return matching->next(); });
    const auto candidates = std::make_shared<const std::vector<std::int32_t>>(candidatesOf(*cloud));
    const auto filter = std::make_shared<VoxelFilter>(OctomapParams{});
    const auto scan = std::make_shared<int>(0);
    // the vehicle drives on, so that voxels come and go as on the road
    add("spurious", set, [=] { return filter->filter(*cloud, *candidates, isometry(poseAt(kTurn * ++*scan))); });
    // in a thread, and so on a heap of its own: the nodes it frees would leave the others' memory in pieces
    const std::shared_ptr<StaticMap> map = std::async(std::launch::async, mapOf, std::cref(*cloud)).get();
    add("static", set, [=] { return map->filter(*cloud, *candidates, Eigen::Isometry3d::Identity()); });
}

}  // namespace lidar_obstacles::bench
