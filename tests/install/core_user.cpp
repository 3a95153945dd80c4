// SPDX-License-Identifier: BSD-3-Clause
// Uses lidar_obstacles::core alone: a scan of points in, obstacles out.
#include <lidar_obstacles/pipelines.h>
#include <cstdio>

using namespace lidar_obstacles;

int main() {
    PointCloud cloud;
    for (int i = 0; i < 400; ++i) {  // a wall 3.8 m wide, 8 m ahead
        cloud.xyz.emplace_back(8.0F, -1.9F + 0.2F * static_cast<float>(i % 20), 0.1F * static_cast<float>(i / 20));
    }
    const DetectionResult result = detect(cloud, DetectorParams{});
    std::printf("%zu returns, %zu obstacles\n", cloud.size(), result.obstacles.size());
    return detect(PointCloud{}, DetectorParams{}).obstacles.empty() ? 0 : 1;
}
