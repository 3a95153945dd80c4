// SPDX-License-Identifier: BSD-3-Clause
// The unseen sides of vehicles: grown to the usual size, never into what was seen.
#include "lidar_obstacles/completion.h"

#include <gtest/gtest.h>

#include "lidar_obstacles/object_models.h"
#include "support/hull_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using Vec2 = Eigen::Vector2d;

const CompletionParams kParams;
const BoxParams& kBox = kParams.box;

/// A vehicle of which the sensor saw just this box.
Obstacle vehicle(const OrientedBox& seen, const std::vector<std::int32_t>& points) {
    Obstacle o;
    o.cls = ObstacleClass::Vehicle;
    o.heading_valid = true;
    o.box = seen;
    o.points = points;
    return o;
}

/// The box of the returns on the first object of a world, told from where the object is: its extents along its axes.
Obstacle seenOf(const World& world, const Scan& scan) {
    const OrientedBox& truth = world.boxes[0];
    Eigen::AlignedBox3d extent;
    for (const std::int32_t i : scan.returnsOn(0)) {
        const Eigen::AngleAxisd to_box(-truth.yaw, Eigen::Vector3d::UnitZ());
        extent.extend(to_box * (scan.cloud.xyz[i].cast<double>() - truth.center));
    }
    OrientedBox seen = truth;
    seen.size.head<2>() = extent.sizes().head<2>().cwiseMax(1e-3);
    seen.center.head<2>() += Eigen::Rotation2Dd(truth.yaw) * extent.center().head<2>();
    return vehicle(seen, scan.returnsOn(0));
}

struct Completed {
    OrientedBox truth;
    Obstacle before;
    Obstacle after;
};

Completed complete(const World& world, const Sensor& sensor = {}, const CompletionParams& params = {}) {
    const Scan scan = castRays(world, sensor);
    const Obstacle seen = seenOf(world, scan);
    return {world.boxes[0], seen, completeBoxes({seen}, scan.cloud, knownGround(scan), params).at(0)};
}

World with(const std::vector<OrientedBox>& boxes) {
    World world = flatWorld();
    world.boxes = boxes;
    return world;
}

/// How far a box reaches in a direction [m].
double reach(const OrientedBox& box, const Vec2& direction) {
    double farthest = -kInfinity;
    for (const Vec2& c : cornersOf(box)) farthest = std::max(farthest, direction.dot(c));
    return farthest;
}

Vec2 axisOf(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }

void expectSameBox(const OrientedBox& a, const OrientedBox& b) {
    EXPECT_EQ(a.center, b.center);
    EXPECT_EQ(a.size, b.size);
    EXPECT_EQ(a.yaw, b.yaw);
}

TEST(Completion, ACarSeenFromBehindGrowsForwardAndItsRearStays) {
    for (const double x : {7.0, 12.0, 20.0})
        for (const double sense : {1.0, -1.0}) {  // ahead; behind, where its front is seen
            const Completed c = complete(with({carAt(sense * x, 0.0, 0.0)}));
            ASSERT_LT(c.before.box.size.x(), 2.5) << "more than the rear and some roof is seen";
            EXPECT_NEAR(c.after.box.size.x(), kBox.car_length, 1e-9) << x;
            EXPECT_NEAR(distanceTo(c.after.box, Vec2::Zero()), distanceTo(c.truth, Vec2::Zero()), 0.01) << x;
            EXPECT_EQ(c.after.box.yaw, c.before.box.yaw);
            EXPECT_EQ(c.after.box.size.z(), c.before.box.size.z());
        }
}

TEST(Completion, ACarSeenFromTheSideGrowsAwayAndItsSideStays) {
    for (const double y : {-6.0, 6.0}) {
        const Completed c = complete(with({carAt(0.5, y, 0.0)}));
        EXPECT_NEAR(c.after.box.size.y(), kBox.car_width, 1e-9);
        EXPECT_NEAR(distanceTo(c.after.box, Vec2::Zero()), distanceTo(c.truth, Vec2::Zero()), 0.01);
        EXPECT_EQ(c.after.box.size.x(), c.before.box.size.x()) << "both ends are seen: nothing to grow";
    }
}

TEST(Completion, FacesTurnedToTheSensorNeverMove) {
    for (const Vec2& place : {Vec2(10, 1), Vec2(8, -4), Vec2(14, 6), Vec2(-9, 2)})
        for (double yaw = -180.0; yaw < 180.0; yaw += 5.0) {
            const Completed c = complete(with({boxAt(place.x(), place.y(), yaw, {3.0, 1.4, 1.5})}));
            for (int k = 0; k < 4; ++k) {
                const Vec2 outwards = axisOf(c.truth.yaw + k * M_PI / 2);
                const double was = reach(c.before.box, outwards);
                const double is = reach(c.after.box, outwards);
                const bool turned_to_sensor = was < 0.0;
                EXPECT_NEAR(turned_to_sensor ? is : was, was, 1e-9) << "yaw " << yaw << " face " << k;
                EXPECT_GE(is, was - 1e-9) << "nothing shrinks";
            }
        }
}

TEST(Completion, NothingGrowsBeyondTheUsualSize) {
    for (double yaw = -180.0; yaw < 180.0; yaw += 15.0) {
        const Completed c = complete(with({boxAt(10.0, 3.0, yaw, {3.0, 1.4, 1.5})}));
        EXPECT_LE(c.after.box.size.x(), kBox.car_length + 1e-9) << yaw;
        EXPECT_LE(c.after.box.size.y(), kBox.car_width + 1e-9) << yaw;
    }
}

TEST(Completion, ATallVehicleGrowsToItsOwnUsualSize) {
    const Completed c = complete(with({boxAt(12.0, 0.0, 0.0, {6.0, 2.0, 2.6})}));
    EXPECT_NEAR(c.after.box.size.x(), kBox.tall_length, 1e-9);
    EXPECT_NEAR(distanceTo(c.after.box, Vec2::Zero()), 9.0, 0.01);
}

TEST(Completion, AWideOneThatMayBeHigherThanWhatWasHitGrowsAsATallOne) {
    const World world = with({boxAt(12.0, 0.0, 0.0, {6.0, 2.1, 1.4})});
    const Scan scan = castRays(world, Sensor{});
    Obstacle o = seenOf(world, scan);
    o.max_height = 2.5;  // the next plane passed above a van's roof
    EXPECT_NEAR(completeBoxes({o}, scan.cloud, knownGround(scan), kParams)[0].box.size.x(), kBox.tall_length, 1e-9);
    o.max_height = 1.8;
    EXPECT_NEAR(completeBoxes({o}, scan.cloud, knownGround(scan), kParams)[0].box.size.x(), kBox.car_length, 1e-9);
    o.max_height = 2.5;
    o.box.size.y() = 1.8;  // as wide as a car
    EXPECT_NEAR(completeBoxes({o}, scan.cloud, knownGround(scan), kParams)[0].box.size.x(), kBox.car_length, 1e-9);
}

TEST(Completion, VehiclesLargerThanUsualKeepTheirSize) {
    for (const Eigen::Vector3d& size : {Eigen::Vector3d(5.0, 1.9, 1.5), Eigen::Vector3d(12.0, 2.55, 3.0)})
        for (const double yaw : {20.0, 45.0, 70.0}) {
            const World world = with({boxAt(14.0, 0.0, yaw, size)});
            const Scan scan = castRays(world, Sensor{});
            const Obstacle whole = vehicle(world.boxes[0], scan.returnsOn(0));
            expectSameBox(completeBoxes({whole}, scan.cloud, knownGround(scan), kParams)[0].box, whole.box);
        }
}

TEST(Completion, GroundThatRisesFarBehindAVehicleStopsNothing) {
    const World world = with({carAt(7.0, 0.0, 0.0)});
    Scan scan = castRays(world, {});
    const GroundModel ground = knownGround(scan);
    for (Eigen::Vector3f& p : scan.cloud.xyz)
        if (p.x() > 15.0f) p.z() += 1.3f;  // its height above the ground stays
    const Obstacle seen = seenOf(world, scan);
    EXPECT_NEAR(completeBoxes({seen}, scan.cloud, ground, kParams).at(0).box.size.x(), kBox.car_length, 1e-9);
}

TEST(Completion, BeamsUnderTheBedOfATruckDoNotStopIt) {
    OrientedBox bed = boxAt(12.0, 0.0, 0.0, {6.0, 2.4, 2.2});
    bed.center.z() = 2.0;  // from .9 m up
    const World world = with({bed});
    const Scan scan = castRays(world, {});
    Obstacle seen = seenOf(world, scan);
    ASSERT_LT(seen.box.size.x(), 0.5) << "only its rear is seen";
    seen.box.center.z() = 1.55;
    seen.box.size.z() = 3.1;
    EXPECT_NEAR(completeBoxes({seen}, scan.cloud, knownGround(scan), kParams).at(0).box.size.x(), kBox.tall_length,
                1e-9);
}

/// The middle one of three cars that are parked side by side, told as if its rear were its side.
Obstacle rearToldAsSide(const World& world, const Scan& scan) {
    Obstacle seen = seenOf(world, scan);
    std::swap(seen.box.size.x(), seen.box.size.y());
    seen.box.yaw -= M_PI / 2;
    seen.faces = kRight;
    return seen;
}

TEST(Completion, ARearInARowOfParkedCarsIsARear) {
    const World world = with({carAt(8.0, 6.0, 90.0), carAt(5.6, 6.0, 90.0), carAt(10.4, 6.0, 90.0)});
    const Scan scan = castRays(world, {});
    const Obstacle seen = rearToldAsSide(world, scan);
    const Obstacle after = completeBoxes({seen}, scan.cloud, knownGround(scan), kParams).at(0);
    EXPECT_NEAR(std::abs(after.box.yaw), M_PI / 2, 0.01);
    EXPECT_NEAR(after.box.size.x(), kBox.car_length, 1e-9);
    EXPECT_EQ(after.faces, after.box.yaw > 0.0 ? kBack : kFront);
    EXPECT_NEAR(after.box.center.x(), world.boxes[0].center.x(), 0.15);
}

TEST(Completion, NoneLeavesTheBoxes) {
    CompletionParams none;
    none.box.completion = Completion::None;
    const Completed c = complete(with({carAt(12.0, 0.0, 0.0)}), Sensor{}, none);
    expectSameBox(c.after.box, c.before.box);
    expectSameBox(c.after.seen_box, c.before.box);
}

TEST(Completion, TheSeenBoxIsWhatWasMeasured) {
    const Completed c = complete(with({carAt(12.0, 0.0, 0.0)}));
    expectSameBox(c.after.seen_box, c.before.box);
    EXPECT_GT(c.after.box.size.x(), c.after.seen_box.size.x());
}

TEST(Completion, OnlyVehiclesWithAHeadingGrow) {
    const World world = with({carAt(12.0, 0.0, 0.0)});
    const Scan scan = castRays(world, Sensor{});
    for (const ObstacleClass cls : {ObstacleClass::Pedestrian, ObstacleClass::Cyclist, ObstacleClass::Unknown}) {
        Obstacle o = seenOf(world, scan);
        o.cls = cls;
        expectSameBox(completeBoxes({o}, scan.cloud, knownGround(scan), kParams)[0].box, o.box);
    }
    Obstacle o = seenOf(world, scan);
    o.heading_valid = false;
    const Obstacle after = completeBoxes({o}, scan.cloud, knownGround(scan), kParams)[0];
    expectSameBox(after.box, o.box);
    expectSameBox(after.seen_box, o.box);
}

TEST(Completion, AVehicleOfWhichOneRingMetTheSillIsAsHighAsVehiclesAreAtLeast) {
    const World world = with({carAt(20.0, 0.0, 0.0)});
    const Scan scan = castRays(world, Sensor{});
    Obstacle seen = seenOf(world, scan);
    for (const double height : {0.1, 1.2}) {
        seen.box.size.z() = height;
        seen.box.center.z() = 0.5 * height;
        const GroundModel ground = knownGround(scan);
        const Obstacle told = completeBoxes({seen}, scan.cloud, ground, kParams).at(0);
        EXPECT_EQ(told.box.size.z(), std::max(height, kLeastVehicleHeight));
        EXPECT_EQ(told.seen_box.size.z(), height);
        const Vec2 place = told.box.center.head<2>();
        EXPECT_NEAR(told.box.center.z(), ground.heightAt(place.x(), place.y()) + 0.5 * told.box.size.z(), 1e-9);
    }
    seen.cls = ObstacleClass::Unknown;
    seen.probability[static_cast<std::size_t>(ObstacleClass::Vehicle)] = 0.4f;
    seen.box.size.z() = 0.1;
    EXPECT_EQ(completeBoxes({seen}, scan.cloud, knownGround(scan), kParams).at(0).box.size.z(), 0.1);
}

TEST(Completion, AVehicleWithoutAHeadingIsAsHighAsVehiclesAreToo) {
    const Scan scan = castRays(with({carAt(20.0, 0.0, 0.0)}), Sensor{});
    Obstacle o = vehicle(boxAt(20.0, 0.0, 0.0, {0.3, 1.7, 0.1}), scan.returnsOn(0));
    o.heading_valid = false;
    const double lower_end = o.box.center.z() - 0.5 * o.box.size.z();
    const Obstacle told = completeBoxes({o}, scan.cloud, knownGround(scan), kParams).at(0);
    EXPECT_EQ(told.box.size, Eigen::Vector3d(0.3, 1.7, kLeastVehicleHeight));
    EXPECT_NEAR(told.box.center.z() - 0.5 * kLeastVehicleHeight, lower_end, 1e-12);
    EXPECT_GE(told.max_height, kLeastVehicleHeight);
    EXPECT_EQ(told.seen_box.size.z(), 0.1);
    CompletionParams none;
    none.box.completion = Completion::None;
    EXPECT_EQ(completeBoxes({o}, scan.cloud, knownGround(scan), none).at(0).box.size.z(), 0.1);
}

TEST(Completion, WithoutObstaclesOrReturnsThereIsNothingToDo) {
    EXPECT_TRUE(completeBoxes({}, PointCloud{}, GroundModel{}, kParams).empty());
    const Obstacle o = vehicle(boxAt(10.0, 0.0, 0.0, {0.1, 1.7, 1.5}), {});
    const Obstacle after = completeBoxes({o}, PointCloud{}, GroundModel{}, kParams).at(0);
    EXPECT_NEAR(after.box.size.x(), kBox.car_length, 1e-9) << "nothing is known to be free";
    EXPECT_NEAR(reach(after.box, {-1.0, 0.0}), -9.95, 1e-9);
}

TEST(Completion, ABoxOnASlopeStandsOnTheGroundWhereItGrewTo) {
    World world = tiltedWorld(5.0, 0.0);
    world.boxes = {standOn(world, carAt(12.0, 0.0, 0.0))};
    const Scan scan = castRays(world, Sensor{});
    GroundModel ground = knownGround(scan);
    ground.plane.slope = world.ground[0].slope;
    Obstacle o = seenOf(world, scan);
    o.box.size.z() = 1.4;
    o.box.center.z() = ground.heightAt(o.box.center.x(), o.box.center.y()) + 0.7;
    const Obstacle after = completeBoxes({o}, scan.cloud, ground, kParams)[0];
    ASSERT_GT(after.box.center.x(), o.box.center.x() + 0.5);
    EXPECT_NEAR(after.box.center.z() - 0.7, ground.heightAt(after.box.center.x(), after.box.center.y()), 1e-9);
}

}  // namespace
}  // namespace lidar_obstacles
