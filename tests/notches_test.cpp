// SPDX-License-Identifier: BSD-3-Clause
// Two things beside each other, which the grid took for one, and one thing that stays one.
#include "grid/notches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "scan/ring_profile.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// A profile of the sensor at (0, 0) looking along x.
std::vector<ProfilePoint> profileOf(const std::vector<Eigen::Vector2f>& places) {
    std::vector<ProfilePoint> profile;
    for (const Eigen::Vector2f& p : places) profile.push_back({p.norm(), p.y() / p.x(), 1.0f / p.x()});
    return profile;
}

TEST(RingProfile, ABodyThatBulgesOutwardsHasNoDepths) {
    for (const float d : depthsOf(profileOf({{10, -1}, {10, 0}, {10, 1}, {11, 1.3f}, {12, 1.6f}})))
        EXPECT_NEAR(d, 0, 1e-5);
}

TEST(RingProfile, DepthsAreFromTheLineBetweenNearerOnes) {
    const auto profile = profileOf({{10, -1}, {12, 0}, {10, 1}});
    const std::vector<float> depth = depthsOf(profile);
    EXPECT_NEAR(depth[1], 2.0f, 1e-4);
    EXPECT_NEAR(notchBetween(profile, depth, 1), 2.0f, 1e-4);
    EXPECT_NEAR(notchBetween(profile, depth, 2), 2.0f, 1e-4);
}

TEST(RingProfile, ASmallJumpIsNoNotch) {
    const auto profile = profileOf({{10, -1}, {10.2f, 0}, {10, 1}});
    EXPECT_EQ(notchBetween(profile, depthsOf(profile), 1), 0.0f);
}

TEST(RingProfile, WhatIsBehindAnEndIsNoNotchOfTheNearerOne) {
    const auto profile = profileOf({{10, -1}, {10, 0}, {14, 0.1f}});
    EXPECT_EQ(notchBetween(profile, depthsOf(profile), 2), 0.0f) << "nothing nearer follows";
}

TEST(RingProfile, OfNothingThereAreNoDepths) {
    EXPECT_TRUE(depthsOf({}).empty());
    EXPECT_EQ(depthsOf(profileOf({{3, 1}})), std::vector<float>{0.0f});
}

/// All returns on the given objects as one piece.
std::vector<Cluster> onePieceOf(const Scan& scan, const std::vector<int>& objects) {
    Cluster piece;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i)
        if (std::count(objects.begin(), objects.end(), scan.hit[i]) > 0)
            piece.points.push_back(static_cast<std::int32_t>(i));
    return {piece};
}

Scan scanOf(const std::vector<OrientedBox>& boxes) {
    World world = flatWorld();
    world.boxes = boxes;
    return castRays(world, Sensor{});
}

/// Of each piece the objects whose returns it has.
std::vector<std::vector<int>> objectsOf(const std::vector<Cluster>& pieces, const Scan& scan) {
    std::vector<std::vector<int>> objects;
    for (const Cluster& piece : pieces) {
        std::vector<int> in;
        for (const std::int32_t i : piece.points)
            if (std::count(in.begin(), in.end(), scan.hit[static_cast<std::size_t>(i)]) == 0)
                in.push_back(scan.hit[static_cast<std::size_t>(i)]);
        std::sort(in.begin(), in.end());
        objects.push_back(in);
    }
    std::sort(objects.begin(), objects.end());
    return objects;
}

using Groups = std::vector<std::vector<int>>;

TEST(Notches, CarsParkedBesideEachOtherAreTwo) {
    // their fronts 5 m to the left, .5 m apart: beams go into the gap
    const Scan scan = scanOf({carAt(7.0, 7.2, 90.0), carAt(9.3, 7.2, 90.0)});
    EXPECT_EQ(objectsOf(partedAtNotches(onePieceOf(scan, {0, 1}), scan.cloud, knownGround(scan).height), scan),
              (Groups{{0}, {1}}));
}

TEST(Notches, APersonBeforeACarIsAnother) {
    const Scan scan = scanOf({carAt(10.0, 0.0, 90.0), personAt(8.4, 0.3)});
    const Groups groups =
        objectsOf(partedAtNotches(onePieceOf(scan, {0, 1}), scan.cloud, knownGround(scan).height), scan);
    EXPECT_EQ(std::count(groups.begin(), groups.end(), std::vector<int>{1}), 1);
    EXPECT_EQ(std::count(groups.begin(), groups.end(), (std::vector<int>{0, 1})), 0);
}

TEST(Notches, ACarIsOneHoweverItIsTurned) {
    for (const double yaw : {0.0, 20.0, 45.0, 70.0, 90.0, 135.0}) {
        const Scan scan = scanOf({carAt(9.0, 2.0, yaw)});
        EXPECT_EQ(partedAtNotches(onePieceOf(scan, {0}), scan.cloud, knownGround(scan).height).size(), 1u) << yaw;
    }
}

TEST(Notches, AWallAtAGrazingAngleIsOne) {
    const Scan scan = scanOf({boxAt(8.0, 1.5, 0.0, {12.0, 0.3, 2.0})});
    EXPECT_EQ(partedAtNotches(onePieceOf(scan, {0}), scan.cloud, knownGround(scan).height).size(), 1u);
}

TEST(Notches, WhatIsSeenThroughWindowsPartsNothing) {
    const Scan scan = scanOf({carAt(7.0, 7.2, 90.0), carAt(9.3, 7.2, 90.0)});
    std::vector<float> height = knownGround(scan).height;
    for (float& h : height) h += 0.8f;
    EXPECT_EQ(partedAtNotches(onePieceOf(scan, {0, 1}), scan.cloud, height).size(), 1u);
}

TEST(Notches, FurtherReturnsOfTheSameBeamsPartNothing) {
    Scan scan = scanOf({boxAt(8.0, 0.0, 90.0, {4.0, 0.1, 0.7})});
    std::vector<Cluster> piece = onePieceOf(scan, {0});
    for (const std::int32_t i : std::vector<std::int32_t>(piece.front().points)) {
        const Eigen::Vector3f p = scan.cloud.xyz[i];
        if (std::abs(p.y()) > 0.2f) continue;  // the edge of a slit, and what is behind it
        piece.front().points.push_back(static_cast<std::int32_t>(scan.cloud.size()));
        scan.cloud.xyz.emplace_back(1.1f * p.x(), 1.1f * p.y(), p.z());
        scan.cloud.ring.push_back(scan.cloud.ring[i]);
        scan.cloud.view.column_of.push_back(scan.cloud.view.column_of[i]);
    }
    ASSERT_GT(scan.cloud.size(), scan.hit.size() + 10);
    const auto parts = partedAtNotches(piece, scan.cloud, knownGround(scan.cloud).height);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts.front().points.size(), piece.front().points.size());
}

TEST(Notches, WhatSeveralSensorsSawStaysWhole) {
    Scan scan = scanOf({carAt(7.0, 7.2, 90.0), carAt(9.3, 7.2, 90.0)});
    const std::vector<Cluster> piece = onePieceOf(scan, {0, 1});
    SensorRays one;
    one.origin = scan.cloud.sensor_origin;
    one.end = piece.front().points[piece.front().points.size() / 2];
    one.end_ring = scan.cloud.view.rings;
    SensorRays other = one;
    other.end = static_cast<std::int32_t>(scan.cloud.size());
    scan.cloud.sensors = {one, other};
    EXPECT_EQ(partedAtNotches(piece, scan.cloud, knownGround(scan).height).size(), 1u);
}

TEST(Notches, ViewsOfOneOrTwoColumnsAreServed) {
    for (const int columns : {1, 2}) {
        PointCloud cloud;
        cloud.xyz = {{5, 0, 0.5f}, {9, 0, 0.5f}};
        cloud.ring = {0, 0};
        cloud.view.rings = 1;
        cloud.view.columns = columns;
        cloud.view.index.assign(static_cast<std::size_t>(columns), 1);
        cloud.view.column_of = {0, columns - 1};
        Cluster piece;
        piece.points = {0, 1};
        EXPECT_EQ(partedAtNotches({piece}, cloud, {0.5f, 0.5f}).size(), 1u);
    }
}

TEST(Notches, NothingIsLostOrTwice) {
    const Scan scan = scanOf({carAt(7.0, 7.2, 90.0), carAt(9.3, 7.2, 90.0), personAt(8.0, 1.0)});
    const std::vector<Cluster> whole = onePieceOf(scan, {0, 1, 2});
    std::vector<std::int32_t> points;
    for (const Cluster& piece : partedAtNotches(whole, scan.cloud, knownGround(scan).height))
        points.insert(points.end(), piece.points.begin(), piece.points.end());
    std::sort(points.begin(), points.end());
    EXPECT_EQ(points, whole.front().points);
}

TEST(Notches, WhatLiesAllAroundTheSensorStaysAsItIs) {
    const Scan scan = scanOf({carAt(7.0, 7.2, 90.0), carAt(9.3, 7.2, 90.0), boxAt(-5.0, 0.0, 0.0, {0.2, 4.0, 2.0})});
    EXPECT_EQ(partedAtNotches(onePieceOf(scan, {0, 1, 2}), scan.cloud, knownGround(scan).height).size(), 1u);
}

TEST(Notches, AreNotLookedForWithoutAView) {
    Scan scan = scanOf({carAt(7.0, 7.2, 90.0), carAt(9.3, 7.2, 90.0)});
    const std::vector<Cluster> piece = onePieceOf(scan, {0, 1});
    scan.cloud.view = {};
    EXPECT_EQ(partedAtNotches(piece, scan.cloud, knownGround(scan).height).size(), 1u);
    EXPECT_TRUE(partedAtNotches({}, scan.cloud, knownGround(scan).height).empty());
}

}  // namespace
}  // namespace lidar_obstacles
