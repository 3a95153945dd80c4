// SPDX-License-Identifier: BSD-3-Clause
// Does it stand or hang? Only a beam that passed below it and went on proves that it hangs (GateParams::max_bottom).
#include <gtest/gtest.h>

#include "lidar_obstacles/recognizer.h"
#include "objects/gates.h"
#include "objects/hanging.h"
#include "support/box_geometry.h"
#include "support/size_model.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// Whether the piece of the object's returns stays; its other returns stay in the scan.
bool stands(const Scan& scan, const GroundModel& ground, int object = 0) {
    std::vector<RejectedCluster> hanging;
    const Cluster piece = clusterOf(scan.returnsOn(object), ground);
    const auto standing = withoutOverhangs({piece}, SurfaceTops(scan.cloud, ground), GateParams{}, hanging);
    EXPECT_EQ(standing.size() + hanging.size(), 1u);
    for (const RejectedCluster& r : hanging) {
        EXPECT_STREQ(toString(r.reason), "floating");
        EXPECT_EQ(r.cluster.points, piece.points);
        EXPECT_EQ(r.measured, piece.bottom);
        EXPECT_GT(r.measured, r.limit);
    }
    return standing.size() == 1;
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

TEST(Standing, ASignWhoseNextPlaneDownMetTheGroundInFrontOfItMayStand) {
    // the plane of -9 deg meets the ground at 11.4 m, that of -3 deg hits the sign at 1.33 m and at 1.12 m
    const auto lowSign = [](double x) { return OrientedBox{{x, 0.0, 1.55}, {0.1, 2.0, 1.0}, 0.0}; };
    EXPECT_FALSE(stands({lowSign(7.0)}, threePlanes()));
    EXPECT_TRUE(stands({lowSign(13.0)}, threePlanes()));
}

TEST(Standing, AVanWhoseBellyABeamPassedStands) {
    // the rear of a van 0.3 m above the ground: 12 m away the plane of -9 deg would pass at -0.1 m, that of -8 deg at
    // 0.11 m below it, and 6 degrees higher one hits it at 1.38 m
    Sensor sensor = threePlanes();
    sensor.lowest_deg = -8.0;
    EXPECT_TRUE(stands({{{12.0 + 2.5, 0.0, 1.3}, {5.0, 2.0, 2.0}, 0.0}}, sensor));
}

TEST(Standing, WhatBeginsLowerThanTheLimitIsNotAskedFor) {
    // a trailer's bed 0.8 m above the ground: beams pass under it, and yet nothing can
    EXPECT_TRUE(stands({{{10.0, 0.0, 1.3}, {4.0, 2.0, 1.0}, 0.0}}, Sensor{}));
}

TEST(Standing, WhatHangsAsAWholeIsRemovedWhateverItIs) {
    World world = flatWorld();
    world.boxes = {signAt(8.0)};
    const Scan scan = castRays(world, Sensor{});
    const GroundModel ground = knownGround(scan);
    SurfaceTops tops(scan.cloud, ground);
    Hypothesis body;
    body.points = scan.returnsOn(0);
    body.chosen = true;
    for (const ObstacleClass cls : {ObstacleClass::Vehicle, ObstacleClass::Structure, ObstacleClass::Unknown}) {
        body.probability = {};
        body.probability[static_cast<std::size_t>(cls)] = 1.0f;
        for (const int hanging : {0, 1}) {
            body.hanging = hanging;
            const Clusters groups = sortGroups({body}, tops, Beams(scan.cloud), GateParams{});
            const bool stays = hanging == 0;
            EXPECT_EQ(groups.accepted.size() + groups.structure.size(), stays ? 1u : 0u) << toString(cls) << hanging;
            ASSERT_EQ(groups.rejected.size(), stays ? 0u : 1u);
            EXPECT_TRUE(stays || groups.rejected[0].reason == RejectReason::Floating);
        }
    }
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

TEST(Standing, WhatNothingCameBackFromBelowMayStand) {
    // no ground at all: the lower planes never came back, which is no proof that they passed under the sign
    World world;
    world.boxes = {signAt(8.0), boxAt(-8.0, 0.0, 0.0, {0.3, 6.0, 6.0})};
    const Scan scan = castRays(world, fewPlanes(8));
    EXPECT_TRUE(stands(scan, knownGround(scan)));
}

TEST(Standing, BeamsBelowMostOfItAreEnough) {
    // a post under a third of the sign stops the beams there
    World world = flatWorld();
    world.boxes = {signAt(8.0), boxAt(8.0, -0.7, 0.0, {0.1, 0.6, 1.2})};
    const Scan third = castRays(world, Sensor{});
    EXPECT_FALSE(stands(third, knownGround(third)));
    world.boxes[1].size.y() = 1.4;  // under two thirds
    world.boxes[1].center.y() = -0.3;
    const Scan most = castRays(world, Sensor{});
    EXPECT_TRUE(stands(most, knownGround(most)));
}

TEST(Standing, WithoutRingsNothingProvesThatItHangs) {
    Sensor sensor = threePlanes();
    sensor.rings = false;
    EXPECT_TRUE(stands({carAt(13.2 + 2.25, 0.0, 0.0)}, sensor));
    EXPECT_TRUE(stands({signAt(9.0)}, sensor));
}

TEST(Standing, AnObstacleBehindAnotherMayStand) {
    // a wall 1.3 m high hides what of the car behind it is lower than 1.18 m: only the plane of -3 deg hits it, at 1.29
    // m
    EXPECT_TRUE(stands({boxAt(12.0, 0.0, 0.0, {4.5, 1.8, 1.5}), boxAt(8.0, 0.0, 0.0, {0.3, 6.0, 1.3})}, Sensor{}));
}

/// The returns on the objects of a world, one piece as seen from above, after what hangs was taken out of it.
struct Parted {
    Scan scan;
    std::vector<std::int32_t> stands, hangs;

    std::size_t hangingOn(int object) const { return static_cast<std::size_t>(scan.countOn(hangs, object)); }
};
/// A recognizer to whom all that may be 2.2 m high is a vehicle, and what is higher several things.
Recognizer lowVehicles() {
    std::vector<ModelTree> trees(kCategories, leaf(0.0f));
    trees[static_cast<std::size_t>(Category::Vehicle)] = stump(Feature::TopLimit, 2.2f, 5.0f, 0.0f);
    trees[static_cast<std::size_t>(Category::Mixture)] = stump(Feature::TopLimit, 2.2f, 0.0f, 5.0f);
    return Recognizer::parse(modelText(trees), "model");
}

Parted withoutHanging(const std::vector<OrientedBox>& boxes) {
    World world = flatWorld();
    world.boxes = boxes;
    Parted parted{castRays(world, Sensor{}), {}, {}};
    const PointCloud& cloud = parted.scan.cloud;
    const GroundModel ground = knownGround(parted.scan);
    std::vector<std::int32_t> points;
    for (std::size_t k = 0; k < boxes.size(); ++k)
        for (const std::int32_t i : parted.scan.returnsOn(static_cast<int>(k)))
            if (ground.height[i] < RegionParams{}.max_height) points.push_back(i);
    std::vector<Cluster> pieces = {clusterOf(points, ground)};
    std::vector<RejectedCluster> hanging;
    const Beams beams(cloud);
    FeatureExtractor featuresOf(beams, ground);
    const SurfaceTops tops(cloud, ground);
    const Recognizer recognizer = lowVehicles();
    const GateParams gates;
    const HangingReturns returns(tops, points, gates.max_bottom);
    HangingParts(tops, returns, featuresOf, recognizer, gates).takeOut(pieces, hanging);
    parted.stands = pieces.front().points;
    for (const RejectedCluster& r : hanging) {
        EXPECT_EQ(r.reason, RejectReason::Floating);
        EXPECT_GT(r.measured, r.limit);
        parted.hangs = r.cluster.points;
    }
    EXPECT_EQ(parted.stands.size() + parted.hangs.size(), points.size());
    return parted;
}

TEST(HangingParts, ACrownAboveACarIsNoneOfIt) {
    // the crown reaches over the front half of the car and 0.7 m beyond it, from 1.95 m up
    const Parted parted = withoutHanging({carAt(9.0, -3.5, 0.0), {{7.4, -3.5, 3.0}, {2.7, 3.2, 2.1}, 0.0}});
    EXPECT_EQ(parted.hangingOn(0), 0u);
    EXPECT_EQ(parted.hangs.size(), parted.hangingOn(1));
    EXPECT_GT(parted.hangs.size(), 40u);
    for (const std::int32_t i : parted.stands) ASSERT_EQ(parted.scan.hit[i], 0);
}

TEST(HangingParts, TheRoofOfACarIsAPartOfItThoughBeamsPassItsWindows) {
    // a body 0.85 m high and a roof 1.45 m high on pillars of no width
    const Parted parted =
        withoutHanging({boxAt(9.0, 3.0, 0.0, {4.5, 1.8, 0.85}), {{8.8, 3.0, 1.5}, {2.2, 1.6, 0.1}, 0.0}});
    EXPECT_TRUE(parted.hangs.empty());
}

}  // namespace
}  // namespace lidar_obstacles
