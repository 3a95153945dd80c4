// SPDX-License-Identifier: BSD-3-Clause
// Obstacles as MRPT's navigation takes them, against geometry worked out by hand and MRPT's own ray angles.
#include "lidar_obstacles/mrpt_bridge/navigation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include "lidar_obstacles/pipelines.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// One obstacle with this box and no returns.
DetectionResult onlyBox(const OrientedBox& box) {
    DetectionResult result;
    result.obstacles.emplace_back();
    result.obstacles.back().box = box;
    return result;
}

/// Points of a scan as MRPT itself places them.
mrpt::maps::CSimplePointsMap mapOf(const mrpt::obs::CObservation2DRangeScan& scan) {
    mrpt::maps::CSimplePointsMap map;
    map.insertionOptions.minDistBetweenLaserPoints = 0.0;
    map.insertionOptions.also_interpolate = false;
    map.insertObservation(scan);
    return map;
}

TEST(Points, AreTheReturnsOfAllThatStands) {
    const Scan scan = castRays(street(), {});
    const DetectionResult result = detect(scan.cloud, {});
    NavigationOptions options;
    options.outline_step = 0.0;
    const auto map = toPointsMap(scan.cloud, result, options);
    EXPECT_EQ(map.size(), result.candidates.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
        float x = 0, y = 0, z = 0;
        map.getPoint(i, x, y, z);
        EXPECT_GT(z, 0.01F) << "no ground, which is at 0";
    }
    options.everything = false;
    std::size_t returns = 0;
    for (const Obstacle& o : result.obstacles)
        if (o.box.center.z() - 0.5 * o.box.size.z() < 2.0) returns += o.points.size();
    EXPECT_EQ(toPointsMap(scan.cloud, result, options).size(), returns);
    EXPECT_LE(returns, result.candidates.size()) << "what is sorted out is no obstacle, but in the way";
}

TEST(Points, CloseTheUnseenSidesOfBoxes) {
    const OrientedBox car = carAt(10.0, 3.0, 30.0);
    const auto map = toPointsMap({}, onlyBox(car), {});
    EXPECT_NEAR(static_cast<double>(map.size()), 2 * (4.5 + 1.8) / 0.2, 4.0);
    const double c = std::cos(car.yaw), s = std::sin(car.yaw);
    for (std::size_t i = 0; i < map.size(); ++i) {
        float x = 0, y = 0, z = 0;
        map.getPoint(i, x, y, z);
        const double dx = x - car.center.x(), dy = y - car.center.y();
        const double along = std::abs(c * dx + s * dy) / 2.25, across = std::abs(-s * dx + c * dy) / 0.9;
        EXPECT_NEAR(std::max(along, across), 1.0, 1e-5) << "on the outline";
        EXPECT_FLOAT_EQ(z, static_cast<float>(car.center.z()));
    }
}

TEST(Points, AreNoneWhereNothingIs) { EXPECT_EQ(toPointsMap({}, {}, {}).size(), 0u); }

TEST(VirtualScan, SeesEachReturnWhereMrptPutsIt) {
    for (const double deg : {-179.0, -90.0, -1.0, 0.0, 45.0, 90.0, 135.0, 179.0}) {
        const double a = radians(deg);
        const PointCloud cloud =
            cloudOf({{static_cast<float>(8 * std::cos(a)), static_cast<float>(8 * std::sin(a)), 1.F}});
        DetectionResult result;
        result.candidates = {0};
        const auto scan = toVirtualScan(cloud, result, {});
        const auto map = mapOf(scan);
        ASSERT_EQ(map.size(), 1u) << deg;
        float x = 0, y = 0, z = 0;
        map.getPoint(0, x, y, z);
        EXPECT_NEAR(std::hypot(x, y), 8.0, 1e-4);
        EXPECT_NEAR(normalizeAngle(std::atan2(y, x) - a), 0.0, radians(0.26)) << "half a ray of 0.5 deg";
    }
}

TEST(VirtualScan, SeesTheNearSidesOfABoxOnly) {
    for (const double bearing : {0.0, 100.0, 180.0, 250.0}) {
        const double a = radians(bearing);
        const OrientedBox car = carAt(10.0 * std::cos(a), 10.0 * std::sin(a), bearing);  // its rear towards us
        const auto scan = toVirtualScan({}, onlyBox(car), {});
        const auto map = mapOf(scan);
        // 1.8 m across at 7.75 m are 13.25 deg: 26 or 27 rays of half a degree.
        EXPECT_GE(map.size(), 26u) << bearing;
        EXPECT_LE(map.size(), 27u) << bearing;
        for (std::size_t i = 0; i < map.size(); ++i) {
            float x = 0, y = 0, z = 0;
            map.getPoint(i, x, y, z);
            EXPECT_NEAR(x * std::cos(a) + y * std::sin(a), 7.75, 1e-3);
        }
    }
}

TEST(VirtualScan, MarksRaysThatMeetNothing) {
    NavigationOptions options;
    options.rays = 360;
    options.scan_range = 9.0;
    const auto scan = toVirtualScan({}, onlyBox(carAt(20.0, 0.0, 0.0)), options);
    ASSERT_EQ(scan.getScanSize(), 360u);
    for (std::size_t i = 0; i < 360; ++i) {
        EXPECT_FALSE(scan.getScanRangeValidity(i));
        EXPECT_EQ(scan.getScanRange(i), 9.F);
    }
    EXPECT_NEAR(scan.aperture, 2 * M_PI * 359 / 360, 1e-5);
}

TEST(VirtualScan, InsideABoxEverythingIsBlocked) {
    const auto scan = toVirtualScan({}, onlyBox(carAt(0.5, 0.0, 20.0)), {});
    for (std::size_t i = 0; i < scan.getScanSize(); ++i) EXPECT_EQ(scan.getScanRange(i), 0.F);
}

TEST(VirtualScan, AWrongResultOrOptionIsRefused) {
    DetectionResult result;
    result.candidates = {5};
    EXPECT_THROW(toVirtualScan({}, result, {}), std::invalid_argument);
    EXPECT_THROW(toPointsMap({}, result, {}), std::invalid_argument);
    NavigationOptions options;
    options.rays = 2;
    EXPECT_THROW(toVirtualScan({}, {}, options), std::invalid_argument);
    options = {};
    options.outline_step = -1.0;
    EXPECT_THROW(toPointsMap({}, {}, options), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles
