// SPDX-License-Identifier: BSD-3-Clause
// Health: mud, a lost ring, a bumped sensor, a wrong rate and lost poses are found within two seconds, and nothing
// else.
#include "lidar_obstacles/health.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "support/watched_scene.h"

namespace lidar_obstacles {
namespace {

using test::Scan;
using test::WatchedScene;

const Scan& street() {
    static const Scan scan = castRays(test::street(), test::Sensor{});
    return scan;
}

double azimuthOf(const Scan& scan, std::int32_t i) {
    const Eigen::Vector3f p = scan.cloud.xyz[i] - scan.cloud.sensor_origin;
    return std::atan2(p.y(), p.x()) * 180.0 / M_PI;
}

Scan tilted(double pitch_deg) {
    return moved(street(), Eigen::AngleAxisd(test::radians(pitch_deg), Eigen::Vector3d::UnitY()).toRotationMatrix(),
                 Eigen::Vector3d::Zero());
}

/// A monitor after three seconds of the street.
struct Watch {
    Watch() {
        for (int k = 0; k < 30; ++k) EXPECT_TRUE(see(street()).ok()) << toText(health.report());
    }

    const HealthReport& see(const Scan& scan) { return health.update(scene.next(scan.cloud)); }
    /// Scans until it is not well any more; 1000 if it stays well for 30.
    int scansUntilFault(const Scan& scan) {
        for (int k = 1; k <= 30; ++k)
            if (!see(scan).ok()) return k;
        return 1000;
    }

    WatchedScene scene;
    HealthMonitor health;
};

TEST(Health, FindsMudWithinTwoSecondsAndItsEnd) {
    Watch watch;
    const Scan muddy = without(street(), [](std::int32_t i) {
        const double azimuth = azimuthOf(street(), i);
        return azimuth > 20.0 && azimuth < 50.0;
    });
    EXPECT_LE(watch.scansUntilFault(muddy), 20);
    const HealthReport& report = watch.see(muddy);
    ASSERT_EQ(report.blocked.size(), 1u);
    EXPECT_NEAR(report.blocked[0].from, test::radians(20.0), 0.02);
    EXPECT_NEAR(report.blocked[0].to, test::radians(50.0), 0.02);
    EXPECT_EQ(toText(report), "blocked 20 to 50 deg");
    for (int k = 0; k < 12; ++k) watch.see(street());
    EXPECT_TRUE(watch.health.report().ok());
}

TEST(Health, KnowsThatASectorBehindIsOneAcrossPi) {
    Watch watch;
    const Scan muddy = without(street(), [](std::int32_t i) { return std::abs(azimuthOf(street(), i)) > 160.0; });
    for (int k = 0; k < 15; ++k) watch.see(muddy);
    ASSERT_EQ(watch.health.report().blocked.size(), 1u);
    EXPECT_NEAR(watch.health.report().blocked[0].from, test::radians(160.0), 0.02);
    EXPECT_NEAR(watch.health.report().blocked[0].to, test::radians(200.0), 0.02);
}

TEST(Health, FindsASilentRing) {
    Watch watch;
    const Scan lost = without(street(), [](std::int32_t i) { return street().cloud.ring[i] == 5; });
    EXPECT_LE(watch.scansUntilFault(lost), 20);
    EXPECT_THAT(watch.see(lost).silent_rings, testing::ElementsAre(5));
}

TEST(Health, FindsABumpedSensor) {
    Watch watch;
    EXPECT_LE(watch.scansUntilFault(tilted(4.5)), 20);
    const HealthReport& report = watch.see(tilted(4.5));
    EXPECT_TRUE(report.turned);
    EXPECT_NEAR(report.turned_by, test::radians(4.5), test::radians(0.7));
}

TEST(Health, IsNotWorriedByARampOrByBraking) {
    Watch watch;
    for (int k = 0; k < 60; ++k)  // up to five degrees and back, in six seconds
        EXPECT_TRUE(watch.see(tilted(5.0 * std::sin(M_PI * k / 60.0))).ok()) << k << toText(watch.health.report());
    for (int k = 0; k < 8; ++k) EXPECT_TRUE(watch.see(tilted(3.5)).ok()) << k;
    EXPECT_TRUE(watch.see(street()).ok());
}

TEST(Health, FindsAWrongRate) {
    Watch watch;
    watch.scene.period = 0.2;
    EXPECT_LE(2 * watch.scansUntilFault(street()), 20);
    EXPECT_TRUE(watch.health.report().wrong_rate);
    EXPECT_NEAR(watch.health.report().usual_rate, 10.0, 0.1);
}

TEST(Health, IsNotWorriedByOneScanLess) {
    Watch watch;
    watch.scene.time += 0.1;
    EXPECT_EQ(watch.scansUntilFault(street()), 1000);
}

TEST(Health, FindsLostPoses) {
    Watch watch;
    watch.scene.losePoses();
    EXPECT_LE(watch.scansUntilFault(street()), 20);
    EXPECT_TRUE(watch.health.report().poses_lost);
}

TEST(Health, BeginsAnewAfterAGap) {
    Watch watch;
    watch.scene.time += 100.0;
    EXPECT_EQ(watch.scansUntilFault(tilted(5.0)), 1000);
}

TEST(Health, OfSourcesWithoutRingsKnowsSectors) {
    test::Sensor sensor;
    sensor.rings = false;
    const Scan scan = castRays(test::street(), sensor);
    const Scan muddy = without(scan, [&](std::int32_t i) { return std::abs(azimuthOf(scan, i)) < 15.0; });
    WatchedScene scene;
    HealthMonitor health;
    for (int k = 0; k < 30; ++k) EXPECT_TRUE(health.update(scene.next(scan.cloud)).ok());
    for (int k = 0; k < 20; ++k) health.update(scene.next(muddy.cloud));
    EXPECT_FALSE(health.report().blocked.empty());
}

}  // namespace
}  // namespace lidar_obstacles
