// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/lasers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/simulation/recording.h"
#include "support/small_worlds.h"

namespace lidar_obstacles::simulation {
namespace {

using test::scanOf;
using test::SmallWorld;
using test::worldOf;

constexpr double kDegree = M_PI / 180.0;

World wallWorld(const std::string& sensor = "") {
    SmallWorld small;
    small.lists =
        "objects: [{model: sedan, s: 112, d: 5, yaw: 30}]\n"
        "clutter: [{type: wall, from: 50, to: 200, d: -14, height: 4}]\n";
    small.sensor = sensor;
    return worldOf(small);
}

TEST(Lasers, OfTheManuals) {
    for (const auto& [layout, count, low, high] : {std::tuple{LaserLayout::Vlp16, 16U, -15.0, 15.0},
                                                   {LaserLayout::Vlp16HiRes, 16U, -10.0, 10.0},
                                                   {LaserLayout::Hdl32, 32U, -30.67, 10.67},
                                                   {LaserLayout::Hdl64, 64U, -24.33, 2.0}}) {
        const std::vector<double> elevations = elevationsOf(layout);
        EXPECT_EQ(elevations.size(), count);
        EXPECT_NEAR(*std::min_element(elevations.begin(), elevations.end()), low * kDegree, 1e-4);
        EXPECT_NEAR(*std::max_element(elevations.begin(), elevations.end()), high * kDegree, 1e-4);
    }
}

TEST(Lasers, AreDecimatedAsTheDetectorCountsRings) {
    std::vector<double> rising;
    for (int k = 0; k < 16; ++k) rising.push_back(k);
    EXPECT_THAT(decimated(rising, 8), testing::ElementsAre(0, 2, 4, 6, 8, 10, 12, 14));
    EXPECT_THAT(decimated(rising, 4), testing::ElementsAre(1, 5, 9, 13));
    EXPECT_EQ(decimated(rising, 16), rising);
    EXPECT_THROW(decimated(rising, 5), std::invalid_argument);
    EXPECT_THROW(decimated(rising, 0), std::invalid_argument);
}

TEST(Lasers, TwoInOneElevationAreAnError) {
    SensorSpec sensor;
    sensor.elevations = {0.1, 0.2, 0.1, 0.3};
    sensor.planes = 0;
    EXPECT_THROW(lasersOf(sensor), std::invalid_argument);
    sensor.elevations = {0.1, 0.2, 0.3};
    sensor.planes = 2;
    EXPECT_THROW(lasersOf(sensor), std::invalid_argument);
}

TEST(Lasers, OfAnotherSensorCastIntoTheirElevations) {
    World world = wallWorld();
    world.scenario.sensor.elevations = elevationsOf(LaserLayout::Hdl32);
    world.scenario.sensor.planes = 0;
    const LidarScan scan = scanOf(world);
    const std::vector<double> elevations = elevationsOf(LaserLayout::Hdl32);
    for (const LidarReturn& r : scan.returns) {
        const Eigen::Vector3f ray = r.point - Eigen::Vector3f(0.0f, 0.0f, 1.9f);
        ASSERT_NEAR(std::atan2(ray.z(), ray.head<2>().norm()), elevations[r.laser], 1e-4);
    }
    EXPECT_THROW(toObservation(scan, world.scenario.sensor), std::invalid_argument);
    EXPECT_EQ(toCloud(scan, world.scenario.sensor).cloud.view.rings, 32);
    EXPECT_EQ(toCloud(scan, world.scenario.sensor, 16).cloud.view.rings, 16);
}

TEST(Lasers, FourPlanesAreThoseTheDetectorKeepsOfSixteen) {
    const LidarScan sixteen = scanOf(wallWorld()), four = scanOf(wallWorld(", planes: 4"));
    std::vector<int> raw, expected;
    for (const LidarReturn& r : four.returns) raw.push_back(r.raw);
    for (const LidarReturn& r : sixteen.returns)
        if (ringOf(r.laser) % 4 == 1) expected.push_back(r.raw);
    EXPECT_EQ(raw, expected);
}

void expectDecodedAlike(const World& world) {
    const LidarScan scan = scanOf(world, 3);
    for (int rings : {16, 8, 4}) {
        SensorParams params;
        params.planes = rings;
        const PointCloud decoded = toPointCloud(*toObservation(scan, world.scenario.sensor), params);
        const ScanCloud own = toCloud(scan, world.scenario.sensor, rings);
        ASSERT_EQ(own.cloud.size(), decoded.size());
        ASSERT_EQ(own.source.size(), decoded.size());
        EXPECT_NO_THROW(validate(own.cloud));
        EXPECT_EQ(own.cloud.view.rings, rings);
        EXPECT_NEAR(own.cloud.timestamp, decoded.timestamp, 1e-5);
        for (std::size_t i = 0; i < decoded.size(); ++i) {
            ASSERT_LT((own.cloud.xyz[i] - decoded.xyz[i]).norm(), 0.011f);  // azimuth units of a packet at 100 m
            ASSERT_EQ(own.cloud.ring[i], decoded.ring[i]);
            ASSERT_FLOAT_EQ(own.cloud.intensity[i], decoded.intensity[i]);
            ASSERT_EQ(own.cloud.view.at(own.cloud.ring[i], own.cloud.view.column_of[i]), static_cast<int>(i));
            ASSERT_EQ(scan.returns[static_cast<std::size_t>(own.source[i])].intensity,
                      static_cast<int>(std::lround(255.0f * own.cloud.intensity[i])));
        }
    }
}

TEST(ScanCloud, IsWhatTheDecoderMakesOfThePackets) {
    World world = wallWorld(", mount_error: {pitch: 2}");
    expectDecodedAlike(world);
    EXPECT_THROW(toCloud(scanOf(world), world.scenario.sensor, 7), std::invalid_argument);
    world.scenario.sensor.planes = 0;
    world.scenario.sensor.elevations = decimated(elevationsOf(LaserLayout::Hdl64), 16);
    expectDecodedAlike(world);
}

TEST(ScanCloud, OfAnEmptyScanIsEmpty) {
    LidarScan scan;
    scan.turn = turnNumber(0, 10.0);
    const ScanCloud own = toCloud(scan, SensorSpec{});
    EXPECT_TRUE(own.cloud.empty());
    EXPECT_TRUE(own.source.empty());
}

}  // namespace
}  // namespace lidar_obstacles::simulation
