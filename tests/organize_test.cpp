// SPDX-License-Identifier: BSD-3-Clause
// Rings for clouds that come without: from elevations that fall on steps, else bands.
#include "scan/organize.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// The usual street by a sensor that does not tell its rings, and which rings they were.
struct Unringed {
    PointCloud cloud;
    std::vector<std::uint16_t> rings;

    explicit Unringed(Sensor sensor, const World& world = street()) {
        rings = castRays(world, sensor).cloud.ring;
        sensor.rings = false;
        cloud = castRays(world, sensor).cloud;
    }
};

void expectRingsOf(const PointCloud& organised, const Unringed& given, int planes) {
    ASSERT_EQ(organised.view.rings, planes);
    ASSERT_EQ(organised.ring.size(), given.rings.size());
    for (std::size_t i = 0; i < given.rings.size(); ++i) ASSERT_EQ(organised.ring[i], given.rings[i]) << i;
}

TEST(Organized, TheSixteenStepsOfASensorAreItsRings) {
    const Unringed given{Sensor{}};
    expectRingsOf(organized(given.cloud), given, 16);
}

TEST(Organized, NoiseOfTheRangesDoesNotMoveThem) {
    Sensor sensor;
    sensor.noise = 0.03;
    const Unringed given(sensor);
    expectRingsOf(organized(given.cloud), given, 16);
}

TEST(Organized, EightAndFourAreFoundAsWell) {
    for (const int planes : {8, 4}) {
        const Unringed given(fewPlanes(planes));
        expectRingsOf(organized(given.cloud), given, planes);
    }
}

TEST(Organized, ATiltedSensorAwayFromTheOriginHasTheSameRings) {
    Unringed given{Sensor{}};
    const Eigen::Matrix3f r =
        Eigen::AngleAxisd(radians(8.0), Eigen::Vector3d(1.0, 1.0, 0.0).normalized()).toRotationMatrix().cast<float>();
    const Eigen::Vector3f shift(1.4f, -0.3f, 0.2f);
    for (Eigen::Vector3f& p : given.cloud.xyz) p = r * p + shift;
    given.cloud.sensor_origin = r * given.cloud.sensor_origin + shift;
    given.cloud.sensor_up = r * given.cloud.sensor_up;
    expectRingsOf(organized(given.cloud), given, 16);
}

TEST(Organized, EveryPlaceOfTheViewHoldsTheNearestOfItsReturns) {
    const PointCloud cloud = organized(Unringed{Sensor{}}.cloud);
    ASSERT_NO_THROW(validate(cloud));
    ASSERT_EQ(cloud.view.column_of.size(), cloud.size());
    const auto range = [&](std::int32_t i) { return (cloud.xyz[i] - cloud.sensor_origin).norm(); };
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(cloud.size()); ++i) {
        const std::int32_t listed = cloud.view.at(cloud.ring[i], cloud.view.column_of[i]);
        ASSERT_GE(listed, 0);
        ASSERT_LE(range(listed), range(i));
        ASSERT_EQ(cloud.ring[listed], cloud.ring[i]);
        ASSERT_EQ(cloud.view.column_of[listed], cloud.view.column_of[i]);
    }
}

TEST(Organized, NeighboursInAzimuthAreNeighboursInTheView) {
    const PointCloud cloud = organized(Unringed{Sensor{}}.cloud);
    for (std::size_t i = 0; i < cloud.size(); i += 37) {
        const Eigen::Vector3f d = cloud.xyz[i] - cloud.sensor_origin;
        const double middle = (cloud.view.column_of[i] + 0.5) * 2.0 * M_PI / cloud.view.columns - M_PI;
        EXPECT_LE(std::abs(std::remainder(std::atan2(d.y(), d.x()) - middle, 2.0 * M_PI)), 1.01 * M_PI / 1800.0);
    }
}

TEST(Organized, ElevationsWithoutStepsGiveBandsOfTwoDegrees) {
    PointCloud cloud = cloudOf({});
    cv::RNG random(3);
    for (int k = 0; k < 5000; ++k) {
        const double azimuth = random.uniform(-M_PI, M_PI);
        const double elevation = radians(random.uniform(-15.0, 15.0));
        const double range = random.uniform(3.0, 40.0);
        cloud.xyz.push_back(cloud.sensor_origin +
                            (range * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                                     std::cos(elevation) * std::sin(azimuth), std::sin(elevation)))
                                .cast<float>());
    }
    const PointCloud organised = organized(cloud);
    EXPECT_NEAR(organised.view.rings, 15, 1);
    ASSERT_NO_THROW(validate(organised));
    const float lowest = radians(-15.0);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f d = (cloud.xyz[i] - cloud.sensor_origin).normalized();
        const double band = (std::asin(d.z()) - lowest) / radians(2.0);
        EXPECT_NEAR(organised.ring[i] + 0.5, band, 0.52) << i;
    }
}

TEST(Organized, AnotherUpIsCountedFromTheSensorsHorizon) {
    const PointCloud cloud = organized(Unringed{Sensor{}}.cloud);
    EXPECT_EQ(cloud.xyz.size(), Unringed{Sensor{}}.rings.size()) << "no return is added or lost";
}

TEST(Organized, ATiltedSensorKeepsTheColumnsOfItsTurn) {
    Sensor fast;  // 20 turns a second
    fast.columns = 900;
    PointCloud cloud = castRays(street(), fast).cloud;
    cloud.sensor_up = Eigen::Vector3f(0.5f, 0.0f, 0.866f).normalized();
    EXPECT_EQ(facingUp(std::move(cloud)).view.columns, 900);
}

TEST(Organized, WhatHasAViewOrNoReturnsIsReturnedAsItIs) {
    const PointCloud given = castRays(street(), Sensor{}).cloud;
    const PointCloud same = organized(given);
    EXPECT_EQ(same.view.index, given.view.index);
    EXPECT_EQ(same.ring, given.ring);
    EXPECT_TRUE(organized(PointCloud{}).view.empty());
}

TEST(Organized, FewReturnsAndReturnsAtTheSensorAreServed) {
    for (const std::vector<Eigen::Vector3f>& points : {std::vector<Eigen::Vector3f>{{10.0f, 0.0f, 1.0f}},
                                                       {{0.0f, 0.0f, 1.8f}},
                                                       {{5.0f, 0.0f, 1.8f}, {5.0f, 0.0f, 1.8f}}}) {
        const PointCloud cloud = organized(cloudOf(points));
        EXPECT_NO_THROW(validate(cloud));
        EXPECT_EQ(cloud.ring.size(), points.size());
    }
}

}  // namespace
}  // namespace lidar_obstacles
