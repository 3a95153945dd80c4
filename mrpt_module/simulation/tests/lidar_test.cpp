// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/simulation/recording.h"
#include "support/small_worlds.h"

namespace lidar_obstacles::simulation {
namespace {

using test::scanOf;
using test::SmallWorld;
using test::worldOf;

/// Things at all ranges and bearings, seen from a vehicle that drives and turns.
World busyWorld(const std::string& sensor = "") {
    SmallWorld small;
    small.ego = "[{t: 0, s: 90, d: -3}, {t: 5, s: 160, d: 4}, {t: 10, s: 230, d: -3}]";
    small.lists =
        "objects: [{model: sedan, s: 112, d: 5, yaw: 30}, {model: truck, path: [{t: 0, s: 60, d: 8}, {t: 10, s: 260, "
        "d: 8}]}, {model: pedestrian, s: 96, d: -6}]\n"
        "clutter: [{type: wall, from: 50, to: 200, d: -14, height: 4}, {type: tree, s: 104, d: 12}, {type: building, "
        "s: 180, d: 40}]\n";
    small.sensor = sensor;
    return worldOf(small);
}

std::size_t shotsOf(const LidarScan& scan) {
    return static_cast<std::size_t>(scan.turn.packets) * kFiringsPerPacket * kLasers;
}

TEST(Lidar, DecodedPacketsGiveBackTheCastPoints) {
    for (double rate : {5.0, 10.0, 20.0}) {
        const World world = busyWorld(", rate: " + std::to_string(rate));
        const LidarScan scan = scanOf(world, 7);
        const PointCloud cloud = toPointCloud(*toObservation(scan, world.scenario.sensor), SensorParams{});
        ASSERT_EQ(cloud.size(), scan.returns.size());
        EXPECT_GT(cloud.size(), shotsOf(scan) / 3);
        float worst = 0.0f;
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            worst = std::max(worst, (cloud.xyz[i] - scan.returns[i].point).norm());
            EXPECT_EQ(cloud.ring[i], ringOf(scan.returns[i].laser));
            EXPECT_NEAR(cloud.time_offset[i], scan.returns[i].time, 2e-6);  // the packet's clock counts microseconds
        }
        // Half a unit of the distance (1 mm), half a unit of the azimuth at 100 m (9 mm).
        RecordProperty("worst_at_" + std::to_string(static_cast<int>(rate)) + "_Hz", std::to_string(worst));
        EXPECT_LT(worst, 0.011f) << "at " << rate << " Hz";
    }
}

TEST(Lidar, MrptAgreesOnTheFirstFirings) {
    const World world = busyWorld();
    const LidarScan scan = scanOf(world, 3);
    const auto observation = toObservation(scan, world.scenario.sensor);
    mrpt::obs::CObservationVelodyneScan::TGeneratePointCloudParameters params;
    params.minDistance = 0.0f;
    observation->minRange = 0.0;
    observation->generatePointCloud(params);
    const auto& cloud = observation->point_cloud;
    std::vector<LidarReturn> first;
    for (const LidarReturn& r : scan.returns)
        if (r.firing % 2 == 0) first.push_back(r);
    ASSERT_EQ(cloud.x.size(), first.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
        const Eigen::Vector3f theirs(cloud.x[i], cloud.y[i], cloud.z[i] + 1.9f);
        // Their azimuth is rounded to 0.01 deg, twice.
        EXPECT_LT((theirs - first[i].point).norm(), 0.004f + 3e-4f * first[i].point.norm());
    }
}

TEST(Lidar, TurnsHaveSeventyFiveOrSixPacketsAndFollowEachOther) {
    std::size_t next = 0;
    for (std::size_t i = 0; i < 200; ++i) {
        const Turn turn = turnNumber(i, 10.0);
        EXPECT_EQ(turn.first_packet, next);
        EXPECT_THAT(turn.packets, testing::AnyOf(75, 76));
        // It begins with the first packet after the sensor passed its x axis.
        const double turns = turnsAt(turn.start(), 10.0);
        EXPECT_GE(turns, static_cast<double>(i) - 1e-6);
        EXPECT_LT(turns, static_cast<double>(i) + 10.0 * kPacketPeriod);
        next = turn.first_packet + static_cast<std::size_t>(turn.packets);
    }
}

TEST(Lidar, TheSameSeedGivesTheSameScanAndAnotherOneAnother) {
    const World world = busyWorld();
    const LidarScan a = scanOf(world, 2, 5), b = scanOf(world, 2, 5), c = scanOf(world, 2, 6);
    ASSERT_EQ(a.returns.size(), b.returns.size());
    for (std::size_t i = 0; i < a.returns.size(); ++i) {
        EXPECT_EQ(a.returns[i].raw, b.returns[i].raw);
        EXPECT_EQ(a.returns[i].intensity, b.returns[i].intensity);
    }
    EXPECT_NE(a.returns.size(), c.returns.size());
}

TEST(Lidar, EightPlanesAreEverySecondOfSixteenFromTheLowest) {
    const LidarScan sixteen = scanOf(busyWorld()), eight = scanOf(busyWorld(", planes: 8"));
    std::vector<LidarReturn> expected;
    for (const LidarReturn& r : sixteen.returns)
        if (ringOf(r.laser) % 2 == 0) expected.push_back(r);
    ASSERT_EQ(eight.returns.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(eight.returns[i].laser, expected[i].laser);
        EXPECT_EQ(eight.returns[i].raw, expected[i].raw);
    }
}

TEST(Lidar, RainSendsBackTheShareThatWasAskedFor) {
    const World world = busyWorld(", rain: 0.1");
    const LidarScan scan = scanOf(world);
    double drops = 0.0;
    for (const LidarReturn& r : scan.returns) {
        if (r.object != kOnNothing) continue;
        ++drops;
        EXPECT_LT(r.point.norm(), 15.0f + 2.0f);
    }
    const auto shots = static_cast<double>(shotsOf(scan));
    EXPECT_NEAR(drops / shots, 0.1, 5.0 * std::sqrt(0.1 * 0.9 / shots));
    for (const LidarReturn& r : scanOf(busyWorld()).returns) EXPECT_NE(r.object, kOnNothing);
}

TEST(Lidar, NoiseHasTheDeviationThatWasAskedFor) {
    SmallWorld small;
    small.lists = "clutter: [{type: building, s: 130, d: 0, length: 20, width: 30, height: 8}]\n";
    World world = worldOf(small);
    world.scenario.sensor.range_noise = 0.02;
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (const LidarReturn& r : scanOf(world).returns) {
        const Eigen::Vector3d ray = r.point.cast<double>() - Eigen::Vector3d(0.0, 0.0, 1.9);
        if (r.normal.x() > -0.9f) continue;  // the front stands 20 m before us
        const double error = ray.norm() * (1.0 - 20.0 / ray.x());
        sum += error, squares += error * error, ++n;
    }
    ASSERT_GT(n, 1000.0);
    EXPECT_NEAR(sum / n, 0.0, 5.0 * 0.02 / std::sqrt(n));
    EXPECT_NEAR(std::sqrt(squares / n), 0.02, 0.001);
}

TEST(Lidar, EachLaserIsAlwaysWrongByTheSame) {
    SmallWorld small;
    small.lists = "clutter: [{type: building, s: 130, d: 0, length: 20, width: 30, height: 8}]\n";
    const World exact = worldOf(small);
    small.sensor = ", laser_bias: 0.05";
    const World biased = worldOf(small);
    for (std::size_t index : {0, 4}) {
        const LidarScan a = scanOf(exact, index), b = scanOf(biased, index);
        ASSERT_EQ(a.returns.size(), b.returns.size());
        std::map<int, std::pair<int, int>> range;  // of the difference, per laser
        for (std::size_t i = 0; i < a.returns.size(); ++i) {
            const int difference = b.returns[i].raw - a.returns[i].raw;
            auto& [low, high] = range.try_emplace(a.returns[i].laser, difference, difference).first->second;
            low = std::min(low, difference), high = std::max(high, difference);
        }
        for (const auto& [laser, limits] : range) EXPECT_LE(limits.second - limits.first, 1) << "laser " << laser;
        EXPECT_NE(range.begin()->second, std::next(range.begin())->second);
    }
}

TEST(Lidar, FarAndGrazedGroundIsSeenLess) {
    const World world = worldOf({});
    int near = 0, far = 0;
    for (const LidarReturn& r : scanOf(world).returns) {
        if (r.laser == 0) ++near;  // -15 deg: 7 m away
        if (r.laser == 14) ++far;  // -1 deg: 109 m away, grazed
    }
    const int shots = turnNumber(0, 10.0).packets * kFiringsPerPacket;
    EXPECT_EQ(near, shots);
    EXPECT_LT(far, shots / 10);
}

TEST(Lidar, WhatStandsIsShiftedByTheWayDrivenUpToItsShot) {
    SmallWorld small;
    small.ego = "[{t: 0, s: 100}, {t: 10, s: 250}]";                                                // 15 m/s
    small.lists = "clutter: [{type: building, s: 200, d: 0, length: 20, width: 60, height: 8}]\n";  // front at x = 190
    const World world = worldOf(small);
    const LidarScan scan = scanOf(world, 10);
    int n = 0;
    for (const LidarReturn& r : scan.returns) {
        if (r.normal.x() > -0.9f || r.object != kOnStructure) continue;
        const double x = 190.0 - (100.0 + 15.0 * (scan.turn.start() + r.time));
        EXPECT_NEAR(r.point.x(), x, 0.002);
        ++n;
    }
    EXPECT_GT(n, 500);
}

TEST(Lidar, WhatMovesIsShiftedByItsOwnWayToo) {
    SmallWorld small;
    small.ego = "[{t: 0, s: 100}, {t: 10, s: 250}]";  // 15 m/s
    // A truck before us, 7 m/s slower; its box ends 4 m behind its middle.
    small.lists = "objects: [{model: truck, path: [{t: 0, s: 130, d: 0}, {t: 10, s: 210, d: 0}]}]\n";
    const World world = worldOf(small);
    const LidarScan scan = scanOf(world, 10);
    double first = 1.0, last = 0.0;
    for (const LidarReturn& r : scan.returns) {
        if (r.object != 0 || r.normal.x() > -0.99f || r.point.z() < 1.2f) continue;
        const double t = scan.turn.start() + r.time;
        EXPECT_NEAR(r.point.x(), 130.0 + 8.0 * t - 4.0 - (100.0 + 15.0 * t), 0.003);
        first = std::min<double>(first, r.time);
        last = std::max<double>(last, r.time);
    }
    // It stands straight ahead, on the seam: its halves are a turn of the sensor apart, and 0.7 m.
    EXPECT_GT(last - first, 0.09);
}

TEST(Lidar, AMountingErrorIsInTheRangesAndNotInTheRecordedPose) {
    SmallWorld small;
    small.lists = "clutter: [{type: building, s: 130, d: 0, length: 20, width: 30, height: 8}]\n";
    small.sensor = ", mount_error: {x: 0.5}";
    const World world = worldOf(small);
    const auto observation = toObservation(scanOf(world), world.scenario.sensor);
    EXPECT_DOUBLE_EQ(observation->sensorPose.x(), 0.0);
    const PointCloud cloud = toPointCloud(*observation, SensorParams{});
    float nearest = 100.0f;
    for (const Eigen::Vector3f& p : cloud.xyz)
        if (p.z() > 1.0f) nearest = std::min(nearest, p.x() > 0.0f ? p.x() : 100.0f);
    EXPECT_NEAR(nearest, 19.5f, 0.02f);
}

TEST(Lidar, NumberPlatesAreBrighterThanAnythingDiffuse) {
    // Driving up to a car the planes sweep over its plate.
    const World world = worldOf({"objects: [{model: sedan, s: 120, d: 0}]\n", "[{t: 0, s: 95}, {t: 10, s: 145}]"});
    int reflectors = 0;
    for (std::size_t i = 0; i < 30; ++i)
        for (const LidarReturn& r : scanOf(world, i).returns)
            if (r.intensity > 100) {
                ++reflectors;
                EXPECT_EQ(r.object, 0);
            }
    EXPECT_GT(reflectors, 0);
}

}  // namespace
}  // namespace lidar_obstacles::simulation
