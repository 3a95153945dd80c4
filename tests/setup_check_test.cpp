// SPDX-License-Identifier: BSD-3-Clause
// The first look at a sensor, on scenes whose truth was built.
#include "lidar_obstacles/setup_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

using test::radians;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// What the vehicle sees after it has driven `x` metres along the street, whose walls would look the same everywhere.
PointCloud driven(double x, const std::vector<OrientedBox>& on_board = {}) {
    test::World world = test::street();
    world.boxes.resize(world.boxes.size() - 2);
    for (OrientedBox& box : world.boxes) box.center.x() -= x;
    world.boxes.insert(world.boxes.end(), on_board.begin(), on_board.end());
    return castRays(world, test::Sensor{}).cloud;
}

/// Twenty scans of a drive, ten times a second, a metre apart.
SetupReport drive(const std::vector<OrientedBox>& on_board = {}) {
    SetupCheck check(DetectorParams{});
    for (int k = 0; k < 20; ++k) {
        PointCloud cloud = driven(k, on_board);
        cloud.timestamp = 1000.0 + 0.1 * k;
        check.add(cloud);
    }
    return check.report();
}

SetupReport of(const PointCloud& cloud) {
    SetupCheck check(DetectorParams{});
    check.add(cloud);
    return check.report();
}

TEST(SetupCheck, NoScansSayNothing) {
    const SetupReport r = SetupCheck(DetectorParams{}).report();
    EXPECT_EQ(r.scans, 0U);
    EXPECT_FALSE(r.height);
    EXPECT_THAT(toLines(r), IsEmpty());
    EXPECT_THAT(settingsFor(r, DetectorParams{}), IsEmpty());
}

TEST(SetupCheck, AnEmptyScanIsAScanWithoutGround) {
    const SetupReport r = of(PointCloud{});
    EXPECT_EQ(r.scans, 1U);
    EXPECT_EQ(r.with_ground, 0U);
    EXPECT_THAT(toLines(r), Contains(HasSubstr("no ground in any scan")));
}

TEST(SetupCheck, ALevelSensorNeedsNoSettings) {
    const SetupReport r = drive();
    EXPECT_EQ(r.scans, 20U);
    EXPECT_EQ(r.with_ground, 20U);
    EXPECT_NEAR(*r.height, 1.8, 0.02);
    EXPECT_LT(r.tilt, radians(0.3));
    EXPECT_EQ(r.rings, 16);
    EXPECT_NEAR(r.lowest, radians(-15.0), radians(0.1));
    EXPECT_NEAR(r.view, radians(360.0), radians(0.1));
    EXPECT_NEAR(r.rate, 10.0, 0.01);
    EXPECT_TRUE(r.moved);
    EXPECT_THAT(settingsFor(r, DetectorParams{}), IsEmpty());
}

TEST(SetupCheck, TheTiltOfAMountIsThatOfTheGround) {
    for (const double pitch : {3.0, 12.0, 20.0}) {
        const auto rotation = Eigen::AngleAxisd(radians(pitch), Eigen::Vector3d::UnitY()).toRotationMatrix();
        const SetupReport r = of(moved(castRays(test::street(), test::Sensor{}), rotation, {0, 0, 0}).cloud);
        ASSERT_TRUE(r.height) << pitch;
        EXPECT_NEAR(r.tilt, radians(pitch), radians(0.5));
        EXPECT_NEAR(*r.height, 1.8, 0.05) << pitch;
        EXPECT_NEAR(r.up.x(), std::sin(radians(pitch)), 0.01);
        const auto settings = settingsFor(r, DetectorParams{});
        if (pitch > 6.0) {
            EXPECT_THAT(settings, Contains(HasSubstr("ground.max_slope_deg = "))) << pitch;
        } else {
            EXPECT_THAT(settings, IsEmpty()) << pitch;
        }
    }
}

TEST(SetupCheck, WhatTheVehicleCarriesIsOfferedAsItsBody) {
    OrientedBox rack = test::boxAt(1.6, 0.0, 0.0, {0.4, 1.0, 0.3});
    rack.center.z() = 1.75;
    const SetupReport r = drive({rack});
    ASSERT_THAT(r.own_body.parts(), testing::SizeIs(1));
    EXPECT_TRUE(r.own_body.holds({1.4f, 0.0f, 1.75f}));
    EXPECT_THAT(settingsFor(r, DetectorParams{}),
                ElementsAre(AllOf(HasSubstr("region.own_body = box(-1, 1, -0.6, 0.6) box("), HasSubstr("# stays"))));
    DetectorParams knows;
    knows.region.own_body = "box(1.3, 1.9, -0.6, 0.6)";
    SetupCheck check(knows);
    for (int k = 0; k < 20; ++k) check.add(driven(k, {rack}));
    EXPECT_THAT(check.report().own_body.parts(), IsEmpty());
    EXPECT_GT(check.report().own_share, 0.001);
}

TEST(SetupCheck, ASilentRingIsNamedAndTheHighestOnesAreNot) {
    const test::Scan scan = castRays(test::street(), test::Sensor{});
    const auto lost = [&](std::int32_t i) { return scan.cloud.ring[i] == 5 || scan.cloud.ring[i] == 15; };
    const SetupReport r = of(without(scan, lost).cloud);
    EXPECT_THAT(r.silent_rings, ElementsAre(5));
    EXPECT_THAT(toLines(r), Contains(HasSubstr("ring 5 is silent")));
}

TEST(SetupCheck, GapsAndStepsBackOfTheStampsAreCounted) {
    SetupCheck check(DetectorParams{});
    PointCloud cloud = driven(0.0);
    for (const double time : {0.0, 0.1, 0.2, 0.5, 0.6, 0.4, 0.5, 0.6}) {
        cloud.timestamp = 1000.0 + time;
        check.add(cloud);
    }
    const SetupReport r = check.report();
    EXPECT_NEAR(r.rate, 10.0, 0.01);
    EXPECT_EQ(r.gaps, 1U);
    EXPECT_EQ(r.steps_back, 1U);
    EXPECT_FALSE(r.moved);
}

TEST(SetupCheck, TurnsBeginWhereTheFirstReturnIs) {
    PointCloud cloud = driven(0.0);
    for (const Eigen::Vector3f& p : cloud.xyz) {
        const double azimuth = std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x()));
        const double turned = std::fmod(radians(90.0) - azimuth + 4.0 * M_PI, 2.0 * M_PI);  // clockwise from the left
        cloud.time_offset.push_back(static_cast<float>(0.1 * turned / (2.0 * M_PI)));
    }
    const SetupReport r = of(cloud);
    ASSERT_TRUE(r.turn_begins);
    EXPECT_NEAR(*r.turn_begins, radians(90.0), radians(1.0));
    EXPECT_FALSE(of(driven(0.0)).turn_begins);
}

TEST(SetupCheck, WithoutRingsItSaysSo) {
    test::Sensor sensor;
    sensor.rings = false;
    const SetupReport r = of(castRays(test::street(), sensor).cloud);
    EXPECT_EQ(r.rings, 0);
    EXPECT_THAT(toLines(r), Contains(HasSubstr("rings: none named")));
}

}  // namespace
}  // namespace lidar_obstacles
