// SPDX-License-Identifier: BSD-3-Clause
// Uses lidar_obstacles::mrpt_bridge: an MRPT observation in, obstacles out.
#include <lidar_obstacles/mrpt_bridge/observations.h>
#include <lidar_obstacles/pipelines.h>
#include <cstdio>

using namespace lidar_obstacles;

int main() {
    const mrpt::obs::CObservationVelodyneScan scan;
    const PointCloud cloud = toPointCloud(scan, SensorParams{});
    const DetectionResult result = detect(cloud, DetectorParams{});
    std::printf("%zu returns, %zu obstacles\n", cloud.size(), result.obstacles.size());
    return result.obstacles.empty() ? 0 : 1;
}
