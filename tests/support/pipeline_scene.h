// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The usual street as the pipelines see it, and what they make of it.
#pragma once

#include <gtest/gtest.h>

#include "support/box_geometry.h"

namespace lidar_obstacles::test {

inline Scan streetScan(int planes = 16) {
    Sensor sensor = fewPlanes(planes);
    sensor.noise = 0.02;
    return castRays(street(), sensor);
}

/// The obstacle that holds most of the returns on an object; null if none does.
inline const Obstacle* obstacleOn(const Scan& scan, const std::vector<Obstacle>& obstacles, int object) {
    const Obstacle* best = nullptr;
    std::ptrdiff_t most = 0;
    for (const Obstacle& o : obstacles) {
        const auto on = scan.countOn(o.points, object);
        if (on <= most) continue;
        most = on;
        best = &o;
    }
    return best;
}

inline void expectSame(const std::vector<Obstacle>& a, const std::vector<Obstacle>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_EQ(a[k].box.center, b[k].box.center);
        EXPECT_EQ(a[k].box.size, b[k].box.size);
        EXPECT_EQ(a[k].box.yaw, b[k].box.yaw);
        EXPECT_EQ(a[k].points, b[k].points);
    }
}

}  // namespace lidar_obstacles::test
