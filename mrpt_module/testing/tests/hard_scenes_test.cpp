// SPDX-License-Identifier: BSD-3-Clause
// Things that detectors are known to take for others: a car below a crown, riders who cross, what a wet road mirrors.
// Recorded cases lie beside the labelled data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "lidar_obstacles/testing/matchers.h"
#include "lidar_obstacles/testing/scenario.h"
#include "support/test_data.h"

namespace lidar_obstacles::testing {
namespace {

using test::labelledData;
using ::testing::Not;

/// Scan by scan, without tracks.
RawlogResult scanByScan(const std::string& recording) {
    RawlogOptions options;
    options.params.tracking.enabled = false;
    return detectRawlog(recording, options);
}

RawlogResult simulatedScanByScan(const std::string& objects, const std::string& clutter) {
    ScenarioOptions options;
    options.params.tracking.enabled = false;
    return detectScenario(
        "duration: 0.5\n"
        "track: {width: 14, segments: [{straight: 200}]}\n"
        "sensor: {pose: {z: 1.8}}\n"
        "ego: {path: [{t: 0, s: 60}, {t: 1, s: 60}]}\n"
        "objects:\n" +
            objects + "clutter:\n" + clutter,
        options);
}

std::vector<Obstacle> vehiclesOf(const ScanObstacles& scan) {
    std::vector<Obstacle> vehicles;
    for (const Obstacle& o : scan.obstacles)
        if (o.cls == Vehicle) vehicles.push_back(o);
    return vehicles;
}

class RecordedCase : public ::testing::Test {
  protected:
    void SetUp() override {
        if (labelledData("../cases").empty()) GTEST_SKIP() << "no recorded cases beside the labelled data";
    }
};

TEST_F(RecordedCase, ACarUnderATreeIsTheOnlyVehicleAndHasItsHeight) {
    LIDAR_OBSTACLES_NEED(recording, labelledData("../cases/car-under-tree/car-under-tree.pcap"));
    for (const ScanObstacles& scan : scanByScan(recording)) {
        const std::vector<Obstacle> vehicles = vehiclesOf(scan);
        ASSERT_EQ(vehicles.size(), 1U) << scan.scan;
        EXPECT_NEAR(distanceTo(vehicles[0].box), 7.2, 0.3) << scan.scan;
        EXPECT_NEAR(vehicles[0].box.size.z(), 1.5, 0.3) << scan.scan << ": a car, not its crown";
    }
}

TEST_F(RecordedCase, ATreeAloneIsNoRoadUser) {
    LIDAR_OBSTACLES_NEED(recording, labelledData("../cases/car-under-tree/tree-alone-control.pcap"));
    for (const ScanObstacles& scan : scanByScan(recording)) {
        EXPECT_THAT(scan, Not(HasObstacle(Vehicle)));
        EXPECT_THAT(scan, Not(HasObstacle(Pedestrian)));
        EXPECT_THAT(scan, Not(HasObstacle(Cyclist)));
    }
}

TEST_F(RecordedCase, RidersWhoCrossAreRidersWhoseHeadingIsAlongTheRideOrNotTold) {
    LIDAR_OBSTACLES_NEED(recording, labelledData("../cases/rider-crossing/rider-crossing.rawlog"));
    struct Rider {
        double x, y, yaw;
    };
    int headings = 0, riders = 0, scans = 0;
    for (const ScanObstacles& scan : scanByScan(recording)) {
        ++scans;
        for (const Rider& r : {Rider{9, 2, 90}, Rider{6, -3, 45}, Rider{14, 5, 0}, Rider{12, -5, 90}}) {
            for (const Obstacle& o : scan.obstacles) {
                if (o.cls == Structure || std::hypot(o.box.center.x() - r.x, o.box.center.y() - r.y) > 1.0) continue;
                riders += o.cls == Cyclist;
                if (!o.heading_valid) continue;
                ++headings;
                EXPECT_LT(std::abs(std::remainder(o.box.yaw - r.yaw * M_PI / 180.0, M_PI)), 20 * M_PI / 180.0)
                    << "rider at " << r.x << ", " << r.y << " in scan " << scan.scan;
            }
        }
    }
    EXPECT_GE(riders, 3 * scans) << "of four in each scan";
    EXPECT_GT(headings, scans);
}

TEST_F(RecordedCase, AWetRoadHidesNeitherCarNorPersonAndInventsNothing) {
    LIDAR_OBSTACLES_NEED(recording, labelledData("../cases/wet-road/wet-road.pcap"));
    for (const ScanObstacles& scan : scanByScan(recording)) {
        EXPECT_THAT(scan, HasObstacle(Vehicle).near(12, 1.5, 1.0));
        EXPECT_THAT(scan, HasObstacle(Pedestrian).near(9, -2.5, 0.5));
        int road_users = 0;
        for (const Obstacle& o : scan.obstacles) road_users += o.cls != Structure && o.cls != ObstacleClass::Unknown;
        EXPECT_EQ(road_users, 2) << scan.scan;
    }
}

TEST(CarUnderATree, IsFoundWhereverTheTrunkBehindItStands) {
    for (const double dy : {-1.5, 0.0}) {  // trunk behind the car, and beside its front
        const std::string at = std::to_string(-4.0 + dy);
        const RawlogResult scans = simulatedScanByScan(
            "  - {model: sedan, s: 70, d: -4}\n",
            "  - {type: tree, s: 73.5, d: " + at + ", height: 6, width: 5, leaves: 0.3, variant: 3}\n");
        for (const ScanObstacles& scan : scans) EXPECT_THAT(scan, HasObstacle(Vehicle).near(10, -4, 1.0)) << dy;
    }
}

}  // namespace
}  // namespace lidar_obstacles::testing
