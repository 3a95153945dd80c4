// SPDX-License-Identifier: BSD-3-Clause
// Uses lidar_obstacles::evaluation, which needs no MRPT.
#include <lidar_obstacles/evaluation/box_overlap.h>
#include <lidar_obstacles/evaluation/metrics.h>

#include <cstdio>

using namespace lidar_obstacles;

int main() {
    OrientedBox box;
    box.size = {4, 2, 1.5};
    const evaluation::Metrics metrics = evaluation::summarise({}, {});
    std::printf("%zu scans, overlap with itself %.1f\n", metrics.scans, evaluation::bevIou(box, box));
    return metrics.scans == 0 && evaluation::bevIou(box, box) > 0.99 ? 0 : 1;
}
