// SPDX-License-Identifier: BSD-3-Clause
// What is high above the road is a part of a truck, and of nothing else.
#include "lidar_obstacles/pipelines.h"

#include <gtest/gtest.h>

#include "support/pipeline_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

DetectionResult found(const World& world, Scan& scan) {
    Sensor sensor;
    sensor.noise = 0.015;
    scan = castRays(world, sensor);
    return detect(scan.cloud, DetectorParams{});
}

/// A truck seen from behind: its body begins 1.2 m above the road; below are two axles and a bar between the wheels.
World truckFromBehind(double rear) {
    World world = flatWorld();
    world.boxes = {{{rear + 4.0, 0.0, 2.35}, {8.0, 2.5, 2.3}, 0.0}};
    for (const double x : {rear + 1.5, rear + 6.5})
        for (const double y : {-1.0, 1.0}) world.boxes.push_back({{x, y, 0.5}, {1.0, 0.35, 1.0}, 0.0});
    world.boxes.push_back({{rear + 0.3, 0.0, 0.55}, {0.1, 2.3, 0.15}, 0.0});
    return world;
}

TEST(HighVehicles, ATruckWhoseBodyBeamsPassBelowIsFound) {
    for (const double rear : {8.0, 10.0, 12.0, 14.0, 16.0, 20.0}) {
        Scan scan;
        const DetectionResult r = found(truckFromBehind(rear), scan);
        const Obstacle* truck = nullptr;  // the largest vehicle: what is above 2.5 m may have a box of its own
        for (const Obstacle& o : r.obstacles)
            if (o.cls == ObstacleClass::Vehicle && (truck == nullptr || o.points.size() > truck->points.size()))
                truck = &o;
        ASSERT_NE(truck, nullptr) << rear;
        EXPECT_GT(2 * scan.countOn(truck->points, 0), scan.countOn(r.candidates, 0)) << rear;
        EXPECT_NEAR(distanceTo(truck->box, Eigen::Vector2d::Zero()), rear, 0.3) << rear;
        for (const RejectedCluster& c : r.clusters.rejected) EXPECT_EQ(scan.countOn(c.cluster.points, 0), 0) << rear;
    }
}

TEST(HighVehicles, WhatHangsAbovePeopleIsNoPartOfThem) {
    // an awning from 2.1 m up, 3 m deep, above two people 8 m ahead
    World world = flatWorld();
    world.boxes = {{{8.0, -1.0, 0.9}, {0.4, 0.6, 1.8}, 0.0},
                   {{8.0, 1.0, 0.9}, {0.4, 0.6, 1.8}, 0.0},
                   {{8.5, 0.0, 2.25}, {3.0, 5.0, 0.3}, 0.0}};
    Scan scan;
    const DetectionResult r = found(world, scan);
    EXPECT_EQ(obstacleOn(scan, r.obstacles, 2), nullptr) << "beams passed below the awning";
    for (const int person : {0, 1}) {
        const Obstacle* o = obstacleOn(scan, r.obstacles, person);
        ASSERT_NE(o, nullptr);
        for (const std::int32_t i : o->points) EXPECT_EQ(scan.hit[static_cast<std::size_t>(i)], person);
    }
}

}  // namespace
}  // namespace lidar_obstacles
