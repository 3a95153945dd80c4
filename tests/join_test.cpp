// Pieces of one vehicle that the planes leave apart.
#include <gtest/gtest.h>

#include "lidar_obstacles/clustering.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// A car seen from the front as few planes see it: bumper and hood 0.7 m high, the windscreen 1.2 m behind.
World carFromTheFront(double x) {
    World world = flatWorld();
    world.boxes = {boxAt(x + 0.6, 0.0, 0.0, {1.2, 1.8, 0.7}), boxAt(x + 2.7, 0.0, 0.0, {3.0, 1.7, 1.5})};
    return world;
}

/// One component per box.
std::vector<Cluster> componentsOf(const Scan& scan, int boxes) {
    std::vector<Cluster> components;
    for (int b = 0; b < boxes; ++b) {
        components.emplace_back();
        components.back().points = scan.returnsOn(b);
    }
    return components;
}

std::vector<Cluster> join(const Scan& scan, int boxes) {
    return joinFragments(componentsOf(scan, boxes), scan.cloud, knownGround(scan), ClusteringParams{});
}

TEST(Join, ABumperAndTheWindscreenBehindItAreOneCar) {
    for (const double x : {7.0, 9.0, 12.0}) {
        const Scan scan = castRays(carFromTheFront(x), Sensor{});
        const auto joined = join(scan, 2);
        ASSERT_EQ(joined.size(), 1u) << x;
        EXPECT_EQ(joined[0].points.size(), scan.returnsOn(0).size() + scan.returnsOn(1).size());
    }
}

TEST(Join, SourcesWithoutRingsAreLeftUnchanged) {
    Sensor sensor;
    sensor.rings = false;
    const Scan scan = castRays(carFromTheFront(9.0), sensor);
    EXPECT_EQ(join(scan, 2).size(), 2u);
}

TEST(Join, WhatTogetherIsLongerThanACarStaysApart) {
    World world = flatWorld();
    world.boxes = {boxAt(10.0, 0.0, 0.0, {4.0, 1.8, 0.7}), boxAt(15.5, 0.0, 0.0, {4.0, 1.8, 1.5})};
    EXPECT_EQ(join(castRays(world, Sensor{}), 2).size(), 2u);
}

TEST(Join, APersonInFrontOfACarStaysAPerson) {
    World world = flatWorld();
    world.boxes = {personAt(9.0, 0.0), carAt(13.0, 0.0, 0.0)};
    EXPECT_EQ(join(castRays(world, Sensor{}), 2).size(), 2u);
}

TEST(Join, APersonBehindALowWallStaysAPerson) {
    World world = flatWorld();
    world.boxes = {boxAt(9.0, 0.0, 0.0, {0.3, 5.0, 0.6}), personAt(10.5, 0.0)};
    EXPECT_EQ(join(castRays(world, Sensor{}), 2).size(), 2u);
}

TEST(Join, KeepsEveryReturnOnce) {
    const Scan scan = castRays(carFromTheFront(9.0), Sensor{});
    const auto joined = join(scan, 2);
    ASSERT_EQ(joined.size(), 1u);
    auto points = joined[0].points;
    std::sort(points.begin(), points.end());
    EXPECT_EQ(std::adjacent_find(points.begin(), points.end()), points.end());
    EXPECT_EQ(points.size(), scan.returnsOn(0).size() + scan.returnsOn(1).size());
}

}  // namespace
}  // namespace lidar_obstacles
