// Cars that touch something tall: walls, trees.
#include <gtest/gtest.h>

#include "lidar_obstacles/clustering.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

struct TallScene {
    Scan scan;
    GroundModel ground;

    explicit TallScene(const std::vector<OrientedBox>& boxes, const Sensor& sensor = {}) {
        World world = flatWorld();
        world.boxes = boxes;
        scan = castRays(world, sensor);
        ground = knownGround(scan);
    }
    /// The candidates on all boxes as one component.
    Cluster together() const {
        Cluster c;
        for (std::size_t i = 0; i < scan.cloud.size(); ++i)
            if (scan.hit[i] != kOnGround && ground.height[i] <= RegionParams{}.max_height)
                c.points.push_back(static_cast<std::int32_t>(i));
        return c;
    }
    std::vector<Cluster> split(const std::vector<Cluster>& components) const {
        return splitFromTall(components, scan.cloud, ground, DetectorParams{});
    }
    double shareOn(const Cluster& c, int object) const {
        const auto on = std::count_if(c.points.begin(), c.points.end(), [&](int i) { return scan.hit[i] == object; });
        return static_cast<double>(on) / static_cast<double>(c.points.size());
    }
    /// Candidates on an object that a cluster holds, of all of them.
    double heldOf(const Cluster& c, int object) const {
        const auto on = std::count_if(c.points.begin(), c.points.end(), [&](int i) { return scan.hit[i] == object; });
        const Cluster all = together();
        const auto of =
            std::count_if(all.points.begin(), all.points.end(), [&](int i) { return scan.hit[i] == object; });
        return static_cast<double>(on) / static_cast<double>(of);
    }
};

// Seen up to 1.8 m + 12 m * tan 15 deg = 5.0 m: higher than any vehicle, as the gates have it (4.2 m).
const OrientedBox kHouse = boxAt(0.0, 12.5, 0.0, {16.0, 1.0, 7.0});
const OrientedBox kParked = boxAt(0.5, 10.3, 0.0, {4.5, 1.8, 1.5});  // 0.8 m from it

TEST(Tall, ACarParkedAtAHouseIsTakenOut) {
    for (const int planes : {16, 8}) {
        const TallScene scene({kParked, kHouse}, fewPlanes(planes));
        const auto parts = scene.split({scene.together()});
        ASSERT_EQ(parts.size(), 2u) << planes;
        EXPECT_EQ(scene.shareOn(parts[1], 0), 1.0) << "nothing of the house is with the car";
        EXPECT_GE(scene.heldOf(parts[1], 0), 0.95);
        EXPECT_EQ(parts[0].points.size() + parts[1].points.size(), scene.together().points.size());
    }
}

TEST(Tall, ACarBesideATrunkIsTakenOut) {
    const TallScene scene({carAt(13.0, 0.0, 20.0), boxAt(12.0, 2.6, 0.0, {0.5, 0.5, 8.0})});
    const auto parts = scene.split({scene.together()});
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(scene.shareOn(parts[0], 1), 1.0);
    EXPECT_EQ(scene.shareOn(parts[1], 0), 1.0);
}

TEST(Tall, EveryReturnStaysInOnePart) {
    const TallScene scene({kParked, kHouse});
    std::vector<std::int32_t> all;
    for (const Cluster& c : scene.split({scene.together()})) all.insert(all.end(), c.points.begin(), c.points.end());
    std::sort(all.begin(), all.end());
    EXPECT_EQ(all, scene.together().points);
}

void expectUnchanged(const TallScene& scene) {
    const Cluster before = scene.together();
    const auto after = scene.split({before});
    ASSERT_EQ(after.size(), 1u);
    EXPECT_EQ(after[0].points, before.points);
}

TEST(Tall, AHouseAloneStaysWhole) { expectUnchanged(TallScene({kHouse})); }

TEST(Tall, ABusAndACarAreNotTall) {
    expectUnchanged(TallScene({boxAt(12.0, 5.0, 0.0, {12.0, 2.55, 3.0})}));
    expectUnchanged(TallScene({carAt(12.0, 3.0, 0.0), boxAt(12.0, 5.5, 0.0, {6.0, 2.0, 2.6})}));
}

TEST(Tall, WhatIsNoVehicleIsNotTakenOut) {
    // a person, and a low wall longer than any car
    expectUnchanged(TallScene({personAt(0.5, 10.5), kHouse}));
    expectUnchanged(TallScene({boxAt(0.0, 10.4, 0.0, {9.0, 0.4, 0.7}), kHouse}));
}

TEST(Tall, OtherComponentsAreNotTouched) {
    const TallScene scene({kParked, kHouse, carAt(-9.0, -3.0, 10.0)});
    Cluster other;
    Cluster both;
    for (const std::int32_t i : scene.together().points) (scene.scan.hit[i] == 2 ? other : both).points.push_back(i);
    const auto parts = scene.split({other, both});
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].points, other.points);
    EXPECT_EQ(scene.shareOn(parts[1], 1), 1.0);
}

TEST(Tall, SourcesWithoutRingsAreLeftUnchanged) {
    Sensor sensor;
    sensor.rings = false;
    expectUnchanged(TallScene({kParked, kHouse}, sensor));
    EXPECT_TRUE(splitFromTall({}, PointCloud{}, GroundModel{}, DetectorParams{}).empty());
}

}  // namespace
}  // namespace lidar_obstacles
