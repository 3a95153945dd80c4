// SPDX-License-Identifier: BSD-3-Clause
// Where there is little ground to see, and where there is none.
#include <gtest/gtest.h>

#include "lidar_obstacles/ground.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// Four walls around the sensor, inner sides `distance` away.
std::vector<OrientedBox> room(double distance, double height) {
    const double side = 2.0 * distance + 1.0;
    const double middle = distance + 0.25;
    return {boxAt(middle, 0.0, 0.0, {0.5, side, height}), boxAt(-middle, 0.0, 0.0, {0.5, side, height}),
            boxAt(0.0, middle, 0.0, {side, 0.5, height}), boxAt(0.0, -middle, 0.0, {side, 0.5, height})};
}

/// Walls that begin far below: nothing of the ground is seen.
std::vector<OrientedBox> shaft(double distance) {
    std::vector<OrientedBox> walls = room(distance, 60.0);
    for (OrientedBox& wall : walls) wall.center.z() = 0.0;
    return walls;
}

void expectNoGround(const PointCloud& cloud) {
    ASSERT_GT(cloud.size(), 100u);
    const GroundModel model = segmentGround(cloud, GroundParams{});
    EXPECT_EQ(model.evidence, GroundEvidence::None);
    EXPECT_EQ(std::count(model.is_ground.begin(), model.is_ground.end(), 1), 0);
    EXPECT_EQ(model.normal, Eigen::Vector3d::UnitZ());
    for (std::size_t i = 0; i < cloud.size(); ++i) ASSERT_EQ(model.height[i], cloud.xyz[i].z());
}

TEST(GroundEvidence, WallsAllAroundAreNoGround) {
    for (const double distance : {3.0, 8.0, 20.0}) {
        SCOPED_TRACE(distance);
        expectNoGround(castRays({{}, shaft(distance)}, Sensor{}).cloud);
    }
}

TEST(GroundEvidence, WallsWithoutRingNumbersAreNoGround) {
    Sensor sensor;
    sensor.rings = false;
    expectNoGround(castRays({{}, shaft(8.0)}, sensor).cloud);
}

TEST(GroundEvidence, ACeilingIsNoGround) {
    World world;
    world.boxes.push_back({{0.0, 0.0, 4.1}, {60.0, 60.0, 0.2}, 0.0});
    expectNoGround(castRays(world, Sensor{}).cloud);
}

TEST(GroundEvidence, ASingleHorizontalPlaneSeesNoGround) {
    Sensor sensor;
    sensor.planes = 1;
    sensor.lowest_deg = 0.0;
    World world = flatWorld();
    world.boxes = room(10.0, 5.0);
    expectNoGround(castRays(world, sensor).cloud);
}

TEST(GroundEvidence, ASingleCarInTheAirIsNoGround) {
    World world;
    world.boxes.push_back(carAt(8.0, 0.0, 30.0));
    expectNoGround(castRays(world, Sensor{}).cloud);
}

TEST(GroundEvidence, OneRingOnTheGroundIsEnough) {
    World world = flatWorld();
    world.boxes = room(7.2, 5.0);  // the plane at -15 deg meets the ground at 6.7 m, the one at -13 deg at 7.8 m
    const Scan scan = castRays(world, Sensor{});
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    EXPECT_NE(model.evidence, GroundEvidence::None);
    const auto ground = scan.returnsOn(kOnGround);
    ASSERT_GT(ground.size(), 500u);
    const auto found = std::count_if(ground.begin(), ground.end(), [&](int i) { return model.is_ground[i] != 0; });
    EXPECT_GE(static_cast<double>(found), 0.98 * static_cast<double>(ground.size()));
    EXPECT_NEAR(model.heightAt(5.0, 3.0), 0.0, 0.1);
}

TEST(GroundEvidence, TwoRingsOnTheGroundAreEnough) {
    Sensor sensor;
    sensor.planes = 4;
    sensor.lowest_deg = -8.0;
    sensor.step_deg = 4.0;  // -8 deg meets the ground at 12.8 m, -4 deg at 25.7 m, the others never
    World world = flatWorld();
    world.boxes = {carAt(10.0, 0.0, 0.0), carAt(-12.0, 5.0, 90.0)};
    const Scan scan = castRays(world, sensor);
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    EXPECT_NE(model.evidence, GroundEvidence::None);
    const auto ground = scan.returnsOn(kOnGround);
    const auto found = std::count_if(ground.begin(), ground.end(), [&](int i) { return model.is_ground[i] != 0; });
    EXPECT_GE(static_cast<double>(found), 0.98 * static_cast<double>(ground.size()));
}

TEST(GroundEvidence, GroundSeenInOneDirectionOnlyIsFound) {
    World world = flatWorld();
    world.ground[0].x_min = 1.0;  // behind: a drop
    const Scan scan = castRays(world, Sensor{});
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    EXPECT_NE(model.evidence, GroundEvidence::None);
    const auto ground = scan.returnsOn(kOnGround);
    const auto found = std::count_if(ground.begin(), ground.end(), [&](int i) { return model.is_ground[i] != 0; });
    EXPECT_GE(static_cast<double>(found), 0.98 * static_cast<double>(ground.size()));
}

TEST(GroundEvidence, AFewReturnsBelowTheGroundDoNotPullItDown) {
    Scan scan = castRays(flatWorld(), Sensor{});
    int mirrored = 0;  // wet road: every 50th return of the ground comes from a mirror image below it
    for (std::size_t i = 0; i < scan.cloud.size(); i += 50) {
        scan.cloud.xyz[i].z() = -1.0f;
        ++mirrored;
    }
    ASSERT_GT(mirrored, 100);
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    for (double angle = 0.0; angle < 2 * M_PI; angle += 0.3)
        EXPECT_NEAR(model.heightAt(8.0 * std::cos(angle), 8.0 * std::sin(angle)), 0.0, 0.1);
}

TEST(GroundSeeds, AreInTheOrderOfBinAndRow) {
    const PointCloud cloud = castRays(street(), Sensor{}).cloud;
    const auto seeds = groundSeeds(cloud, azimuthBins(cloud));
    ASSERT_GT(seeds.size(), 100u);
    for (std::size_t i = 1; i < seeds.size(); ++i)
        ASSERT_LT(std::make_pair(seeds[i - 1].bin, seeds[i - 1].row), std::make_pair(seeds[i].bin, seeds[i].row));
    EXPECT_GE(seeds.front().bin, 0);
    EXPECT_LT(seeds.back().bin, kSeedBins);
    EXPECT_TRUE(groundSeeds(PointCloud{}, {}).empty());
}

TEST(GroundSeeds, LieInTheirAzimuthBin) {
    for (const bool rings : {true, false}) {
        Sensor sensor;
        sensor.rings = rings;
        const PointCloud cloud = castRays(street(), sensor).cloud;
        const std::vector<std::uint8_t> bins = azimuthBins(cloud);
        ASSERT_EQ(bins.size(), cloud.size());
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            const double bin = 5.0 * bins[i] + 2.5 - 180.0;  // its middle, 72 bins of 5 deg
            const double azimuth = degrees(std::atan2(cloud.xyz[i].y(), cloud.xyz[i].x()));
            // half a bin, one column of 0.2 deg, and 0.3 deg of fastAtan2
            ASSERT_LE(std::abs(std::remainder(azimuth - bin, 360.0)), 2.5 + 0.2 + 0.3);
        }
    }
}

TEST(FastAtan2, HoldsItsPromiseInAllDirections) {
    for (double a = -M_PI + 1e-4; a < M_PI; a += 0.001)
        for (const double r : {1e-3, 1.0, 100.0})
            ASSERT_NEAR(fastAtan2(static_cast<float>(r * std::sin(a)), static_cast<float>(r * std::cos(a))), a,
                        radians(0.3));
    EXPECT_TRUE(std::isfinite(fastAtan2(0.0f, 0.0f)));
    EXPECT_NEAR(fastAtan2(0.0f, -1.0f), M_PI, 1e-5);
    EXPECT_NEAR(fastAtan2(-1.0f, 0.0f), -M_PI / 2, 1e-5);
}

/// Share of the returns on a low, broad thing at 18 m that are told as ground. One plane hits it, 0.2 m above the
/// ground.
double shareTakenForGround(double bearing_deg) {
    World world = flatWorld();
    const double x = 18.55 * std::cos(radians(bearing_deg));
    const double y = 18.55 * std::sin(radians(bearing_deg));
    world.boxes = {boxAt(x, y, bearing_deg, {1.5, 1.8, 0.3})};
    const Scan scan = castRays(world, Sensor{});
    const GroundModel ground = segmentGround(scan.cloud, GroundParams{});
    const std::vector<std::int32_t> on_box = scan.returnsOn(0);
    EXPECT_GT(on_box.size(), 10U);
    double taken = 0.0;
    for (const std::int32_t i : on_box) taken += ground.is_ground[i];
    return taken / static_cast<double>(on_box.size());
}

TEST(Ground, ALowThingOnTheScanSeamIsKeptAsAnywhereElse) {
    // the sensor's first column looks straight ahead
    EXPECT_NEAR(shareTakenForGround(0.0), shareTakenForGround(40.0), 0.1);
    EXPECT_LT(shareTakenForGround(0.0), 0.5);
}

}  // namespace
}  // namespace lidar_obstacles
