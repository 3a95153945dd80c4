// SPDX-License-Identifier: BSD-3-Clause
// Packets made by hand: the truth is the geometry they were made from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"
#include "support/velodyne_packets.h"

namespace lidar_obstacles {
namespace {

using namespace test;

const SensorParams kWide{0, 0, 0.0, 200.0};  // all planes, no range limits
constexpr double kQuantum = 0.001;           // half the 2 mm unit of a distance

SensorParams planes(int n) {
    SensorParams params = kWide;
    params.planes = n;
    return params;
}

double azimuthOf(const Eigen::Vector3f& p) { return std::atan2(-p.y(), p.x()); }  // clockwise

class BothModels : public testing::TestWithParam<int> {
  protected:
    Turn turn() const {
        Turn turn;
        turn.model = static_cast<std::uint8_t>(GetParam());
        turn.step = GetParam() == 0x21 ? 16 : 40;
        turn.packets = GetParam() == 0x21 ? 188 : 75;
        return turn;
    }
    int lasers() const { return GetParam() == 0x21 ? 32 : 16; }
};

TEST_P(BothModels, AWallIsFlatForAllReturnsOfABlock) {
    const PointCloud cloud = toPointCloud(makeScan(turn(), wallAt(10.0)), kWide);
    ASSERT_GT(cloud.size(), 5000u);
    for (const auto& p : cloud.xyz) ASSERT_NEAR(p.x(), 10.0, kQuantum + 1e-4);
}

TEST_P(BothModels, ASensorPoseMovesTheWallWithTheSensor) {
    VelodyneScan scan = makeScan(turn(), wallAt(10.0));
    scan.sensorPose = mrpt::poses::CPose3D(1.0, -2.0, 1.7, 0.4, 0.1, -0.2);
    const PointCloud cloud = toPointCloud(scan, kWide);
    for (const auto& p : cloud.xyz) {
        mrpt::math::TPoint3D local;
        scan.sensorPose.inverseComposePoint(mrpt::math::TPoint3D(p.x(), p.y(), p.z()), local);
        ASSERT_NEAR(local.x, 10.0, kQuantum + 1e-4);
    }
    EXPECT_TRUE(cloud.sensor_origin.isApprox(Eigen::Vector3f(1.0f, -2.0f, 1.7f)));
    const auto up = scan.sensorPose.composePoint(mrpt::math::TPoint3D(0, 0, 1));
    EXPECT_NEAR(cloud.sensor_up.z(), up.z - 1.7, 1e-6);
    EXPECT_NEAR(cloud.sensor_up.norm(), 1.0, 1e-6);
}

TEST_P(BothModels, RingsRiseWithElevation) {
    const PointCloud cloud = toPointCloud(makeScan(turn(), sphere(20.0)), kWide);
    std::vector<float> z(static_cast<std::size_t>(lasers()), 100.0f);
    for (std::size_t i = 0; i < cloud.size(); ++i) z[cloud.ring[i]] = cloud.xyz[i].z();
    for (std::size_t r = 1; r < z.size(); ++r) EXPECT_GT(z[r], z[r - 1] + 0.1f) << "ring " << r;
    EXPECT_NEAR(z.front(), 20.0 * std::sin((lasers() == 16 ? -15.0 : -30.67) * M_PI / 180.0), 1e-3);
}

TEST_P(BothModels, EveryReturnHasTheTimeOfItsFiring) {
    const VelodyneScan scan = makeScan(turn(), sphere(20.0));
    const PointCloud cloud = toPointCloud(scan, kWide);
    ASSERT_EQ(cloud.size(), scan.scan_packets.size() * 384);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double block = static_cast<double>(i / 32) * blockTime(turn().model);
        const double expected = 1e-6 * (block + firingTime(turn().model, static_cast<int>(i % 32)));
        ASSERT_NEAR(cloud.time_offset[i], expected, 1e-6) << i;  // the packets' clock ticks in microseconds
    }
    EXPECT_NEAR(cloud.timestamp, 1'000'000.0, 1e-6);
}

TEST_P(BothModels, IntensityIsTheReflectivityOver255) {
    const PointCloud cloud = toPointCloud(makeScan(turn(), sphere(20.0)), kWide);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        ASSERT_FLOAT_EQ(cloud.intensity[i], static_cast<float>(8 * (i % 32)) / 255.0f);
}

TEST_P(BothModels, NeighbouringColumnsOfTheViewAreNeighbourDirections) {
    Turn t = turn();
    t.start = 27'311;
    const PointCloud cloud = toPointCloud(makeScan(t, sphere(20.0)), kWide);
    const OrganizedView& view = cloud.view;
    EXPECT_EQ(view.rings, lasers());
    EXPECT_EQ(view.columns, lasers() == 16 ? 1800 : 2250);  // 0.2 deg and 0.16 deg
    ASSERT_EQ(view.column_of.size(), cloud.size());
    const double column_width = 2.0 * M_PI / view.columns;
    for (int ring = 0; ring < view.rings; ++ring)
        for (int column = 0; column < view.columns; ++column) {
            const int here = view.at(ring, column), next = view.at(ring, view.wrap(column + 1));
            ASSERT_GE(here, 0) << "a full turn leaves no hole";
            const double step = azimuthOf(cloud.xyz[static_cast<std::size_t>(next)]) -
                                azimuthOf(cloud.xyz[static_cast<std::size_t>(here)]);
            ASSERT_NEAR(std::remainder(step - column_width, 2.0 * M_PI), 0.0, 0.1 * column_width);
        }
}

TEST_P(BothModels, DecimationKeepsTheRingsOfTheRuleAndRenumbersThem) {
    const VelodyneScan scan = makeScan(turn(), sphere(20.0));
    const PointCloud all = toPointCloud(scan, kWide), few = toPointCloud(scan, planes(8));
    const int k = lasers() / 8;
    std::vector<Eigen::Vector3f> expected;
    for (std::size_t i = 0; i < all.size(); ++i)
        if ((all.ring[i] - (k - 1) / 2) % k == 0) expected.push_back(all.xyz[i]);
    EXPECT_EQ(few.xyz, expected);
    EXPECT_EQ(*std::max_element(few.ring.begin(), few.ring.end()), 7);
    EXPECT_EQ(few.view.rings, 8);
}

INSTANTIATE_TEST_SUITE_P(Packets, BothModels, testing::Values(0x22, 0x21),
                         [](const auto& test) { return test.param == 0x21 ? "Hdl32" : "Vlp16"; });

/// A dual return scan: `last(k)` and `strongest(k)` are the raw distances of return k.
VelodyneScan dualScan(unsigned last, unsigned strongest) {
    VelodyneScan scan = makeScan({}, sphere(0.0));
    unsigned azimuth = 0;
    for (VelodynePacket& packet : scan.scan_packets) {
        packet.laser_return_mode = 0x39;
        for (int b = 0; b < 12; ++b) {
            setBlock(packet, b, azimuth);
            for (int k = 0; k < 32; ++k) setReturn(packet, b, k, b % 2 == 0 ? last : strongest);
            if (b % 2 == 1) azimuth += 40;
        }
    }
    return scan;
}

TEST(DualReturn, EqualDistancesOfAPairAreKeptOnce) {
    EXPECT_EQ(toPointCloud(dualScan(5000, 5000), kWide).size(), 75u * 384 / 2);
    EXPECT_EQ(toPointCloud(dualScan(5000, 4000), kWide).size(), 75u * 384);
    EXPECT_EQ(toPointCloud(dualScan(5000, 0), kWide).size(), 75u * 384 / 2);
    EXPECT_EQ(toPointCloud(dualScan(0, 5000), kWide).size(), 75u * 384 / 2);
}

TEST(DualReturn, ThePairSharesItsTimeAndPlaceAndTheNearerReturnIsListed) {
    const PointCloud cloud = toPointCloud(dualScan(5000, 4000), kWide);
    EXPECT_EQ(cloud.view.columns, 1800);
    EXPECT_FLOAT_EQ(cloud.time_offset[0], cloud.time_offset[32]);
    EXPECT_EQ(cloud.view.column_of[0], cloud.view.column_of[32]);
    int listed = 0;
    for (std::int32_t i : cloud.view.index) {
        if (i < 0) continue;
        ASSERT_NEAR(cloud.xyz[static_cast<std::size_t>(i)].norm(), 8.0, 1e-3);
        ++listed;
    }
    EXPECT_EQ(listed, 75 * 384 / 2);
}

TEST(PacketClock, StepsAreTakenTheShorterWayAroundTheHour) {
    EXPECT_EQ(clockStep(1000, 3000), 2000.0);
    EXPECT_EQ(clockStep(3000, 1000), -2000.0);
    EXPECT_EQ(clockStep(3'599'999'000, 1000), 2000.0);
    EXPECT_EQ(clockStep(1000, 3'599'999'000), -2000.0);
    EXPECT_EQ(clockStep(0, 1'800'000'000), -1'800'000'000.0);
    EXPECT_EQ(clockStep(0, 1'799'999'999), 1'799'999'999.0);
    EXPECT_EQ(clockStep(0, 4'294'967'295), 694'967'295.0) << "a clock that is damaged";
}

TEST(PacketClock, RunsAcrossTheFullHour) {
    Turn turn;
    turn.clock = 3'599'950'000;
    VelodyneScan scan = makeScan(turn, sphere(20.0));
    for (auto& packet : scan.scan_packets) {
        const std::uint32_t clock = packet.gps_timestamp() % 3'600'000'000U;
        std::memcpy(bytes(packet) + 1200, &clock, 4);
    }
    const PointCloud cloud = toPointCloud(scan, kWide);
    EXPECT_TRUE(std::is_sorted(cloud.time_offset.begin(), cloud.time_offset.end() - 1));
    EXPECT_NEAR(cloud.time_offset.back(), 1e-6 * (899 * 110.592 + 55.296 + 15 * 2.304), 2e-6);
}

TEST(PacketClock, PacketsOutOfOrderKeepTheirTimes) {
    VelodyneScan scan = makeScan({}, sphere(20.0));
    std::swap(scan.scan_packets[0], scan.scan_packets[1]);
    std::swap(scan.scan_packets[40], scan.scan_packets[41]);
    const PointCloud cloud = toPointCloud(scan, kWide);
    const double packet = 12 * 110.592e-6;
    EXPECT_NEAR(cloud.time_offset[0], packet, 1e-6);
    EXPECT_NEAR(cloud.time_offset[384], 0.0, 1e-6);
    EXPECT_NEAR(cloud.time_offset[40 * 384], 41 * packet, 2e-6);
    EXPECT_NEAR(cloud.timestamp, 1'000'000.0 - packet, 2e-6) << "the earliest firing, not the first packet";
}

TEST(Damage, BadBlocksAreSkippedAndBadClocksReplaced) {
    VelodyneScan scan = makeScan({}, sphere(20.0));
    setBlock(scan.scan_packets[3], 5, 0, 0x1234);
    put16(bytes(scan.scan_packets[4]) + 2, 36000);
    const std::uint32_t wrong_clock = 1'800'000'000;
    std::memcpy(bytes(scan.scan_packets[0]) + 1200, &wrong_clock, 4);
    DecodeStats stats;
    const PointCloud cloud = toPointCloud(scan, kWide, &stats);
    EXPECT_EQ(stats.packets, 75);
    EXPECT_EQ(stats.damaged_blocks, 2);
    EXPECT_EQ(stats.retimed_packets, 1);
    EXPECT_EQ(cloud.size(), 75u * 384 - 64) << "a wrong clock costs no returns";
    EXPECT_LT(*std::max_element(cloud.time_offset.begin(), cloud.time_offset.end()), 0.1f);
}

TEST(Calibration, TheDefaultOfAnotherSensorGivesWayToTheOneThatThePacketsName) {
    VelodyneScan scan = makeScan({}, sphere(20.0));
    for (auto& packet : scan.scan_packets) packet.velodyne_model_ID = 0x24;  // a Puck Hi-Res, recorded as a VLP-16
    const auto lowest = [](const PointCloud& cloud) {
        return std::asin(cloud.xyz[0].z() / cloud.xyz[0].norm()) * 180.0 / M_PI;
    };
    EXPECT_NEAR(lowest(toPointCloud(scan, kWide)), -10.0, 1e-3);
    auto& laser = scan.calibration.laser_corrections[3];  // a calibration of its own
    laser.verticalCorrection += 0.01;
    EXPECT_NEAR(lowest(toPointCloud(scan, kWide)), -15.0, 1e-3);
}

TEST(Calibration, OfTheWrongSensorOrOfNoneGivesWayToo) {
    Turn turn;
    turn.model = 0x21;
    for (VelodyneScan scan : {makeScan({}, sphere(20.0)), makeScan(turn, sphere(20.0))}) {
        const PointCloud right = toPointCloud(scan, kWide);
        const bool is_vlp16 = scan.calibration.laser_corrections.size() == 16;
        scan.calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(is_vlp16 ? "HDL32" : "VLP16");
        PointCloud cloud = toPointCloud(scan, kWide);
        EXPECT_EQ(cloud.xyz, right.xyz);
        EXPECT_EQ(cloud.time_offset, right.time_offset);
        scan.calibration = {};
        cloud = toPointCloud(scan, kWide);
        EXPECT_EQ(cloud.xyz, right.xyz);
        EXPECT_EQ(cloud.time_offset, right.time_offset);
    }
}

TEST(Damage, WhatCannotBeAScanIsRefused) {
    VelodyneScan scan = makeScan({}, sphere(20.0));
    scan.scan_packets.resize(1001, scan.scan_packets.front());
    EXPECT_THROW(toPointCloud(scan, kWide), std::runtime_error);
    scan.scan_packets.resize(10);
    scan.sensorPose.x(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW(toPointCloud(scan, kWide), std::runtime_error);
    scan.sensorPose = mrpt::poses::CPose3D();
    scan.calibration.laser_corrections[3].sinVertCorrection = std::numeric_limits<double>::infinity();
    EXPECT_THROW(toPointCloud(scan, kWide), std::runtime_error);
    scan.calibration.laser_corrections.resize(8);
    EXPECT_THROW(toPointCloud(scan, kWide), std::runtime_error);
}

TEST(Limits, RangesOutsideAreDroppedAndTheEndsKept) {
    VelodyneScan scan = makeScan({}, sphere(0.0));
    const unsigned raw[] = {0, 499, 500, 10'000, 10'001, 65'535};  // unit 2 mm
    for (int k = 0; k < 6; ++k) setReturn(scan.scan_packets[0], 0, k, raw[k]);
    SensorParams params = kWide;
    params.min_range = 1.0;
    params.max_range = 20.0;
    EXPECT_EQ(toPointCloud(scan, params).size(), 2u);
    scan.minRange = 10.0;  // the stricter one holds
    EXPECT_EQ(toPointCloud(scan, params).size(), 1u);
    EXPECT_EQ(toPointCloud(makeScan({}, sphere(0.0)), kWide).size(), 0u);
}

TEST(Limits, TheOneThatMrptBeginsWithIsNobodysWord) {
    ASSERT_EQ(VelodyneScan().minRange, 1.0);
    VelodyneScan scan = makeScan({}, sphere(0.6));
    scan.minRange = VelodyneScan().minRange;
    EXPECT_EQ(toPointCloud(scan, kWide).size(), toPointCloud(makeScan({}, sphere(0.6)), kWide).size());
    SensorParams params = kWide;
    params.min_range = 0.7;
    EXPECT_TRUE(toPointCloud(scan, params).empty());
}

TEST(Planes, ThatDoNotDivideTheSensorsAreAnError) {
    const VelodyneScan scan = makeScan({}, sphere(20.0));
    for (int n : {5, 32, 128}) EXPECT_THROW(toPointCloud(scan, planes(n)), std::invalid_argument) << n;
    SensorParams params = kWide;
    params.rings = 64;
    EXPECT_THROW(toPointCloud(scan, params), std::invalid_argument);
}

TEST(Calibration, OffsetsOfALaserMoveItsReturns) {
    VelodyneScan scan = makeScan({}, sphere(20.0));
    for (auto& laser : scan.calibration.laser_corrections) {
        laser.distanceCorrection = 0.5;
        laser.verticalOffsetCorrection = 0.1;
    }
    const PointCloud cloud = toPointCloud(scan, kWide);
    // Along the ray 20.5 m, across it 0.1 m.
    for (const auto& p : cloud.xyz) ASSERT_NEAR(p.norm(), std::hypot(20.5, 0.1), 2e-3);
}

TEST(Calibration, AnAzimuthCorrectionIsTakenOffTheAzimuth) {
    VelodyneScan scan = makeScan({}, sphere(20.0));
    const PointCloud straight = toPointCloud(scan, kWide);
    for (auto& laser : scan.calibration.laser_corrections) laser.azimuthCorrection = 2.0;
    const PointCloud corrected = toPointCloud(scan, kWide);
    for (std::size_t i = 0; i < straight.size(); ++i) {
        const double turned = azimuthOf(straight.xyz[i]) - azimuthOf(corrected.xyz[i]);
        ASSERT_NEAR(std::remainder(turned - 2.0 * M_PI / 180.0, 2.0 * M_PI), 0.0, 1e-5);
    }
}

}  // namespace
}  // namespace lidar_obstacles
