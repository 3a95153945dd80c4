// Does it stand or hang? What the planes below the lowest return tell (GateParams::max_bottom).
#include <gtest/gtest.h>

#include "lidar_obstacles/clustering.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// Whether the object's returns are an obstacle; its other returns stay in the scan.
bool stands(const Scan& scan, const GroundModel& ground, int object = 0) {
    const Clusters gated = gateClusters(scan.cloud, ground, {clusterOf(scan.returnsOn(object), ground)}, GateParams{});
    for (const RejectedCluster& r : gated.rejected) EXPECT_STREQ(toString(r.reason), "floating");
    return gated.accepted.size() == 1;
}

bool stands(const std::vector<OrientedBox>& boxes, const Sensor& sensor) {
    World world = flatWorld();
    world.boxes = boxes;
    const Scan scan = castRays(world, sensor);
    EXPECT_FALSE(scan.returnsOn(0).empty());
    return stands(scan, knownGround(scan));
}

/// Three planes at -9, -3 and 3 deg.
Sensor threePlanes() {
    Sensor sensor;
    sensor.planes = 3;
    sensor.lowest_deg = -9.0;
    sensor.step_deg = 6.0;
    return sensor;
}

/// A sign 2 m wide whose lower edge is 1.2 m high.
OrientedBox signAt(double x) { return {{x, 0.0, 1.7}, {0.1, 2.0, 1.0}, 0.0}; }

TEST(Standing, ACarHitOnlyHighUpStandsWhereTheNextPlaneMeetsTheGroundBeforeIt) {
    // 13.2 m away the plane of -3 deg hits it at 1.11 m; that of -9 deg meets the ground at 11.4 m
    const OrientedBox car = carAt(13.2 + 2.25, 0.0, 0.0);
    World world = flatWorld();
    world.boxes = {car};
    const Scan scan = castRays(world, threePlanes());
    const Cluster seen = clusterOf(scan.returnsOn(0), knownGround(scan));
    ASSERT_GT(seen.bottom, GateParams{}.max_bottom);
    EXPECT_TRUE(stands(scan, knownGround(scan)));
}

TEST(Standing, WhatTheLowestPlaneHitMayReachDown) {
    // the only plane hits the car 5 m away at 1.36 m
    EXPECT_TRUE(stands({carAt(5.0 + 2.25, 0.0, 0.0)}, fewPlanes(1)));
}

TEST(Standing, ASignThatAPlanePassedUnderHangs) {
    // planes 0.42 m apart at 12 m: the lowest on it is below 1.62 m, the next one passed higher than 0.8 m
    EXPECT_FALSE(stands({signAt(12.0)}, Sensor{}));
    // planes of 4 deg, 0.56 m apart at 8 m: -3 deg hits it at 1.38 m, -7 deg passed at 0.82 m
    EXPECT_FALSE(stands({signAt(8.0)}, fewPlanes(8)));
}

TEST(Standing, ASignThatNoPlanePassedUnderMayStand) {
    // planes of 6 deg, 0.9 m apart at 9 m: -3 deg hits it at 1.33 m, -9 deg would pass at 0.37 m and higher; at 10 m
    // 1.28 m and 0.22 m, lower than a vehicle's belly
    EXPECT_FALSE(stands({signAt(9.0)}, threePlanes()));
    EXPECT_TRUE(stands({signAt(10.0)}, threePlanes()));
}

TEST(Standing, ATiltedSensorTellsTheSame) {
    for (const double roll : {-12.0, 12.0}) {
        const Eigen::Matrix3d rotation = Eigen::AngleAxisd(radians(roll), Eigen::Vector3d::UnitY()).toRotationMatrix();
        World world = flatWorld();
        world.boxes = {signAt(8.0), carAt(-13.2 - 2.25, 0.0, 0.0)};
        const Scan level = castRays(world, fewPlanes(8));
        const GroundModel ground = knownGround(level);  // heights are above the ground, however the frame lies
        EXPECT_FALSE(stands(moved(level, rotation, Eigen::Vector3d::Zero()), ground)) << roll;
        const Scan three = castRays(world, threePlanes());
        EXPECT_TRUE(stands(moved(three, rotation, Eigen::Vector3d::Zero()), knownGround(three), 1)) << roll;
    }
}

TEST(Standing, PlanesWithoutReturnsAreTakenToGoOnAsTheOthersDo) {
    // a sign and a wall, no ground at all: the lower planes never came back, and yet they passed under the sign
    World world;
    world.boxes = {signAt(8.0), boxAt(-8.0, 0.0, 0.0, {0.3, 6.0, 6.0})};
    const Scan scan = castRays(world, fewPlanes(8));
    const auto low = [&](std::int32_t i) { return scan.hit[i] == 1 && scan.cloud.ring[i] < 3; };
    const Scan rest = without(scan, low);
    EXPECT_FALSE(stands(rest, knownGround(rest)));
}

TEST(Standing, WithoutRingsWhatBeginsHighHangs) {
    Sensor sensor = threePlanes();
    sensor.rings = false;
    EXPECT_FALSE(stands({carAt(13.2 + 2.25, 0.0, 0.0)}, sensor)) << "nothing tells that it may reach down";
}

TEST(Standing, AnObstacleBehindAnotherMayStand) {
    // a wall 1.3 m high hides what of the car behind it is lower than 1.18 m: only the plane of -3 deg hits it, at 1.29
    // m
    EXPECT_TRUE(stands({boxAt(12.0, 0.0, 0.0, {4.5, 1.8, 1.5}), boxAt(8.0, 0.0, 0.0, {0.3, 6.0, 1.3})}, Sensor{}));
}

}  // namespace
}  // namespace lidar_obstacles
