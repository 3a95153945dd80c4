// SPDX-License-Identifier: BSD-3-Clause
// Boxes that follow walls and hedges.
#include "objects/structure_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "objects/hanging.h"
#include "support/feature_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// The boxes around the returns of the given boxes of a world.
std::vector<Obstacle> boxesAround(const Scan& scan, const std::vector<int>& boxes) {
    const GroundModel ground = knownGround(scan);
    SurfaceTops topOf(scan.cloud, ground);
    Cluster cluster;
    cluster.points = returnsOnAll(scan, boxes);
    cluster.cls = ObstacleClass::Structure;
    cluster.probability[static_cast<std::size_t>(ObstacleClass::Structure)] = 0.9f;
    return structureBoxes(cluster, topOf);
}

/// Expects that the boxes hold each return of the given boxes of the world once, and that it lies in its box.
void expectAllHeld(const std::vector<Obstacle>& boxes, const Scan& scan, const std::vector<int>& of) {
    std::vector<std::int32_t> held;
    for (const Obstacle& o : boxes) {
        EXPECT_EQ(o.num_points, static_cast<int>(o.points.size()));
        for (const std::int32_t i : o.points) {
            held.push_back(i);
            EXPECT_LE(distanceTo(o.box, scan.cloud.xyz[i].head<2>().cast<double>()), 0.01);
        }
    }
    std::vector<std::int32_t> all = returnsOnAll(scan, of);
    std::sort(held.begin(), held.end());
    std::sort(all.begin(), all.end());
    EXPECT_EQ(held, all);
}

TEST(StructureBoxes, NoReturnsGiveNone) {
    const PointCloud cloud;
    const GroundModel ground;
    SurfaceTops topOf(cloud, ground);
    EXPECT_TRUE(structureBoxes(Cluster{}, topOf).empty());
}

TEST(StructureBoxes, AShortWallIsOneBoxWithoutAHeading) {
    const Scan scan = scanOf({wallAt(8.0, -2.0, 2.0, 0.0, 2.0)});
    const auto boxes = boxesAround(scan, {0});
    ASSERT_EQ(boxes.size(), 1u);
    const Obstacle& o = boxes[0];
    EXPECT_EQ(o.cls, ObstacleClass::Structure);
    EXPECT_FALSE(o.heading_valid);
    EXPECT_EQ(o.rule, HeadingRule::None);
    EXPECT_NEAR(o.probability[static_cast<std::size_t>(ObstacleClass::Structure)], 0.9f, 1e-6f);
    EXPECT_NEAR(o.box.size.x(), 4.0, 0.06) << "a beam's width at either end";
    EXPECT_LE(o.box.size.y(), 0.1);
    EXPECT_NEAR(headingError(o.box.yaw, M_PI / 2), 0.0, 0.5);
    EXPECT_EQ(o.box.size, o.seen_box.size);
    EXPECT_EQ(o.num_rings, 7) << "-11 .. 1 deg";
}

TEST(StructureBoxes, ALongWallIsCutIntoPiecesOfSixMetres) {
    const Scan scan = scanOf({wallAt(10.0, -20.0, 20.0, 0.0, 2.0)});
    const auto boxes = boxesAround(scan, {0});
    EXPECT_GE(boxes.size(), 7u);
    EXPECT_LE(boxes.size(), 16u);
    for (const Obstacle& o : boxes) {
        EXPECT_LE(o.box.size.x(), 6.0 + 1e-3);
        EXPECT_LE(o.box.size.y(), 0.2);
    }
    expectAllHeld(boxes, scan, {0});
}

TEST(StructureBoxes, FollowACorner) {
    // an L of two walls 4 m long that meet at (8, 2), open to the sensor's right
    const Scan scan = scanOf({wallAt(12.0, -2.0, 2.0, 0.0, 2.0), boxAt(10.0, 2.0, 0.0, {4.0, 0.05, 2.0})});
    const auto boxes = boxesAround(scan, {0, 1});
    EXPECT_GE(boxes.size(), 2u);
    double area = 0.0;
    for (const Obstacle& o : boxes) area += o.box.size.x() * o.box.size.y();
    EXPECT_LT(area, 0.25 * 4.0 * 4.0) << "the yard between them is free";
    // the middle of the yard lies in no box
    for (const Obstacle& o : boxes) EXPECT_GT(distanceTo(o.box, {10.0, 0.0}), 0.5);
    expectAllHeld(boxes, scan, {0, 1});
}

TEST(StructureBoxes, StandOnTheGroundAndReachAsHighAsTheirSurface) {
    const Scan scan = scanOf({wallAt(8.0, -2.0, 2.0, 0.0, 6.0)});
    const GroundModel ground = knownGround(scan);
    SurfaceTops topOf(scan.cloud, ground);
    Cluster low;  // what lies in the region
    low.points = returnsWhere(scan, 0, [](const Eigen::Vector3f& p) { return p.z() < 2.5f; });
    const auto boxes = structureBoxes(low, topOf);
    ASSERT_EQ(boxes.size(), 1u);
    EXPECT_NEAR(boxes[0].box.center.z() - 0.5 * boxes[0].box.size.z(), 0.0, 1e-6);
    EXPECT_NEAR(boxes[0].box.size.z(), 1.8 + 8.0 * std::tan(radians(15.0)), 0.1);
    EXPECT_EQ(boxes[0].max_height, boxes[0].box.size.z());
}

TEST(StructureBoxes, WhatWasSeenAboveVehiclesOnlyDoesNotReachDown) {
    const Scan scan = scanOf({{{12.0, 0.0, 4.0}, {1.0, 3.0, 2.0}, 0.0}});  // a crown from 3 to 5 m
    const auto boxes = boxesAround(scan, {0});
    ASSERT_FALSE(boxes.empty());
    for (const Obstacle& o : boxes) EXPECT_GE(o.box.center.z() - 0.5 * o.box.size.z(), 3.0 - 1e-4);
}

TEST(StructureBoxes, WhatHangsOverThingsHasBoxesOfItsOwn) {
    // an awning over a box on the pavement, before a wall; seen from above it holds both
    const OrientedBox awning{{8.0, 0.0, 2.3}, {2.0, 4.0, 0.2}, 0.0};
    const Scan scan = scanOf({boxAt(8.0, 0.5, 0.0, {0.6, 0.6, 1.3}), awning, wallAt(15.0, -8.0, 8.0, 0.0, 4.0)});
    const GroundModel ground = knownGround(scan);
    SurfaceTops topOf(scan.cloud, ground);
    std::vector<Cluster> clusters(1);
    clusters[0].points = returnsOnAll(scan, {0, 1});
    clusters[0].bottom = 0.1f;
    const HangingReturns hanging(topOf, clusters[0].points, GateParams{}.max_bottom);
    partAtHanging(clusters, hanging, ground, GateParams{});
    ASSERT_EQ(clusters.size(), 2u);
    EXPECT_EQ(clusters[0].points, scan.returnsOn(0));
    EXPECT_EQ(clusters[1].points, scan.returnsOn(1));
    const std::vector<Obstacle> standing = structureBoxes(clusters[0], topOf);
    ASSERT_EQ(standing.size(), 1u);
    EXPECT_LT(standing[0].box.size.y(), 0.8) << "as wide as what stands";
    const std::vector<Obstacle> above = structureBoxes(clusters[1], topOf);
    ASSERT_FALSE(above.empty());
    for (const Obstacle& o : above) EXPECT_GT(o.box.center.z() - 0.5 * o.box.size.z(), 2.0) << "one can pass below";
}

TEST(StructureBoxes, WhatNoBeamPassedBelowStands) {
    // a wall that the rings meet from the ground up
    const Scan scan = scanOf({wallAt(8.0, -2.0, 2.0, 0.0, 2.4)});
    const GroundModel ground = knownGround(scan);
    SurfaceTops topOf(scan.cloud, ground);
    std::vector<Cluster> clusters(1);
    clusters[0].points = returnsOnAll(scan, {0});
    clusters[0].bottom = 0.1f;
    const HangingReturns hanging(topOf, clusters[0].points, GateParams{}.max_bottom);
    partAtHanging(clusters, hanging, ground, GateParams{});
    ASSERT_EQ(clusters.size(), 1u);
    EXPECT_EQ(clusters[0].points, returnsOnAll(scan, {0}));
}

TEST(StructureBoxes, AreNotOfTheTopOfATruck) {
    const OrientedBox truck{{14.0, 0.0, 1.75}, {8.0, 2.5, 3.5}, 0.3};
    const Scan scan = scanOf({truck});
    const GroundModel ground = knownGround(scan);
    SurfaceTops topOf(scan.cloud, ground);
    Cluster high;  // what lies above the region
    high.cls = ObstacleClass::Structure;
    high.points = returnsWhere(scan, 0, [](const Eigen::Vector3f& p) { return p.z() > 2.5f; });
    ASSERT_GT(high.points.size(), 20u);
    Obstacle found;
    found.box = truck;
    for (const ObstacleClass cls : {ObstacleClass::Vehicle, ObstacleClass::Unknown}) {
        found.cls = cls;
        std::vector<Obstacle> boxes = {found};
        addStructureBoxes({high}, topOf, boxes);
        EXPECT_EQ(boxes.size() == 1u, cls == ObstacleClass::Vehicle);
    }
}

TEST(StructureBoxes, AreNotOfScrapsWithinARoadUser) {
    const OrientedBox car = carAt(12.0, 0.0, 20.0);
    const Scan scan = scanOf({car, boxAt(18.0, 3.0, 0.0, {0.5, 0.5, 1.0})});
    const GroundModel ground = knownGround(scan);
    SurfaceTops topOf(scan.cloud, ground);
    Obstacle found;
    found.cls = ObstacleClass::Vehicle;
    found.box = car;
    for (const int thing : {0, 1}) {
        Cluster scrap;
        scrap.cls = ObstacleClass::Unknown;
        scrap.points = scan.returnsOn(thing);
        scrap.points.resize(3);
        std::vector<Obstacle> boxes = {found};
        addStructureBoxes({scrap}, topOf, boxes);
        EXPECT_EQ(boxes.size() == 1u, thing == 0);
    }
}

TEST(StructureBoxes, OneReturnHasABoxOfItsOwn) {
    const PointCloud cloud = cloudOf({{10.0f, 1.0f, 1.0f}});
    const GroundModel ground = knownGround(cloud);
    SurfaceTops topOf(cloud, ground);
    Cluster one;
    one.points = {0};
    const auto boxes = structureBoxes(one, topOf);
    ASSERT_EQ(boxes.size(), 1u);
    EXPECT_TRUE(isFinite(boxes[0].box));
    EXPECT_GT(boxes[0].box.size.minCoeff(), 0.0);
    EXPECT_LE(distanceTo(boxes[0].box, {10.0, 1.0}), 1e-6);
    EXPECT_EQ(boxes[0].num_rings, 0) << "the source has none";
}

}  // namespace
}  // namespace lidar_obstacles
