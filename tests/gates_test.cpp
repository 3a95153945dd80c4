// SPDX-License-Identifier: BSD-3-Clause
// What is no obstacle, and what is structure: every reason, reached by a group made for it.
#include <gtest/gtest.h>

#include "objects/gates.h"
#include "objects/structure_boxes.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// Returns on the four upright edges of a box, every 10 cm: as long, wide and high as told, its bottom at `bottom`.
PointCloud boxCloud(const Eigen::Vector3f& size, float bottom, float x = 10.0f) {
    PointCloud cloud = cloudOf({});
    const int steps = std::max(1, static_cast<int>(std::lround(size.z() / 0.1f)));
    for (int k = 0; k <= steps; ++k)
        for (const float u : {-0.5f, 0.5f})
            for (const float v : {-0.5f, 0.5f})
                cloud.xyz.emplace_back(x + u * size.x(), v * size.y(), bottom + size.z() * k / steps);
    return cloud;
}

/// The gates of the bare paper on all returns.
Clusters gate(const PointCloud& cloud, const GateParams& params = {}) {
    const GroundModel ground = knownGround(cloud);
    SurfaceTops topOf(cloud, ground);
    return gateBySize({clusterOf(allReturns(cloud), ground)}, topOf, params, HullFitParams{}.person);
}

/// A chosen group of these returns that the recognizer gave one class with a probability, and Unknown the rest.
Hypothesis groupOf(std::vector<std::int32_t> points, ObstacleClass cls = ObstacleClass::Vehicle,
                   float probability = 1.0f) {
    Hypothesis h;
    h.points = std::move(points);
    h.probability[static_cast<std::size_t>(ObstacleClass::Unknown)] = 1.0f - probability;
    h.probability[static_cast<std::size_t>(cls)] += probability;
    h.whole = 1.0f;
    h.chosen = true;
    return h;
}

Clusters sorted(const Hypothesis& group, const PointCloud& cloud, const GateParams& params = {}) {
    const GroundModel ground = knownGround(cloud);
    SurfaceTops topOf(cloud, ground);
    return sortGroups({group}, topOf, Beams(cloud), params);
}

/// Expects that the only cluster is rejected, and returns with what.
RejectedCluster rejectedFor(RejectReason reason, const Clusters& clusters) {
    EXPECT_TRUE(clusters.accepted.empty());
    EXPECT_TRUE(clusters.structure.empty());
    if (clusters.rejected.size() != 1) {
        ADD_FAILURE() << "accepted, not " << toString(reason);
        return {};
    }
    EXPECT_STREQ(toString(clusters.rejected[0].reason), toString(reason));
    return clusters.rejected[0];
}

TEST(GateBySize, NoComponentsGiveNone) {
    const Clusters clusters = gate(PointCloud{});
    EXPECT_TRUE(clusters.accepted.empty());
    EXPECT_EQ(clusters.rejected.size(), 1u) << "one without returns is no obstacle";
}

TEST(GateBySize, ACarPassesWithItsHeightsAsAVehicle) {
    const Clusters clusters = gate(boxCloud({4.5f, 1.8f, 1.3f}, 0.2f));
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_TRUE(clusters.rejected.empty());
    EXPECT_NEAR(clusters.accepted[0].bottom, 0.2f, 1e-5f);
    EXPECT_NEAR(clusters.accepted[0].top, 1.5f, 1e-5f);
    EXPECT_EQ(clusters.accepted[0].cls, ObstacleClass::Vehicle);
}

TEST(GateBySize, WhatIsNoLargerThanAPersonIsAPedestrian) {
    const Clusters clusters = gate(boxCloud({0.4f, 0.5f, 1.5f}, 0.2f));
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_EQ(clusters.accepted[0].cls, ObstacleClass::Pedestrian);
}

TEST(GateBySize, ALoneReturnIsTooFew) {
    const RejectedCluster r = rejectedFor(RejectReason::TooFewPoints, gate(cloudOf({{10.0f, 0.0f, 1.0f}})));
    EXPECT_EQ(r.measured, 1.0);
    EXPECT_EQ(r.limit, GateParams{}.min_points);
    EXPECT_EQ(r.cluster.points.size(), 1u);
}

TEST(GateBySize, AsManyReturnsAsTheLimitAreEnough) {
    GateParams params;
    params.min_points = 8;
    EXPECT_EQ(gate(boxCloud({1.0f, 1.0f, 0.1f}, 0.8f), params).accepted.size(), 1u);  // two layers of four
    params.min_points = 9;
    rejectedFor(RejectReason::TooFewPoints, gate(boxCloud({1.0f, 1.0f, 0.1f}, 0.8f), params));
}

TEST(GateBySize, ReturnsOnOneSpotAreTooSmall) {
    const PointCloud cloud = cloudOf(std::vector<Eigen::Vector3f>(8, {10.0f, 0.0f, 1.0f}));
    EXPECT_EQ(rejectedFor(RejectReason::TooSmall, gate(cloud)).measured, 0.0);
}

TEST(GateBySize, AWallIsTooLarge) {
    const RejectedCluster r = rejectedFor(RejectReason::TooLarge, gate(boxCloud({20.0f, 0.3f, 1.5f}, 0.2f)));
    EXPECT_NEAR(r.measured, 20.0, 0.01);
    EXPECT_EQ(r.limit, GateParams{}.max_length);
}

TEST(GateBySize, AShrubberyAsWideAsItIsLongIsTooLarge) {
    const RejectedCluster r = rejectedFor(RejectReason::TooLarge, gate(boxCloud({6.0f, 5.0f, 1.5f}, 0.2f)));
    EXPECT_NEAR(r.measured, 5.0, 0.01);
    EXPECT_EQ(r.limit, GateParams{}.max_width);
}

TEST(SortGroups, OnlyWhatIsChosenBecomesAGroup) {
    const PointCloud cloud = boxCloud({4.5f, 1.8f, 1.3f}, 0.2f);
    Hypothesis h = groupOf(allReturns(cloud));
    EXPECT_EQ(sorted(h, cloud).accepted.size(), 1u);
    h.chosen = false;
    const Clusters none = sorted(h, cloud);
    EXPECT_TRUE(none.accepted.empty());
    EXPECT_TRUE(none.structure.empty());
    EXPECT_TRUE(none.rejected.empty());
}

TEST(SortGroups, RoadUsersAreCandidatesAndWhatIsSurelyStructureIsNone) {
    const PointCloud cloud = boxCloud({4.5f, 1.8f, 1.3f}, 0.2f);
    for (const ObstacleClass cls : {ObstacleClass::Vehicle, ObstacleClass::Pedestrian, ObstacleClass::Cyclist}) {
        const Clusters clusters = sorted(groupOf(allReturns(cloud), cls, 0.6f), cloud);
        ASSERT_EQ(clusters.accepted.size(), 1u);
        EXPECT_EQ(clusters.accepted[0].cls, cls);
        EXPECT_EQ(clusters.accepted[0].points, allReturns(cloud));
        EXPECT_NEAR(clusters.accepted[0].probability[static_cast<std::size_t>(cls)], 0.6f, 1e-6f);
    }
    const Clusters wall = sorted(groupOf(allReturns(cloud), ObstacleClass::Structure, 0.9f), cloud);
    EXPECT_TRUE(wall.accepted.empty());
    ASSERT_EQ(wall.structure.size(), 1u);
    EXPECT_EQ(wall.structure[0].cls, ObstacleClass::Structure);
}

TEST(SortGroups, StructureInDoubtIsUnknownAndGetsABoxOfItsOwn) {
    const PointCloud cloud = boxCloud({4.5f, 1.8f, 1.3f}, 0.2f);
    const Clusters clusters = sorted(groupOf(allReturns(cloud), ObstacleClass::Structure, 0.7f), cloud);
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_EQ(clusters.accepted[0].cls, ObstacleClass::Unknown);
}

TEST(SortGroups, WhatIsNotMoreLikelyThanNotOfItsClassIsUnknown) {
    const PointCloud cloud = boxCloud({4.5f, 1.8f, 1.3f}, 0.2f);
    Hypothesis h = groupOf(allReturns(cloud), ObstacleClass::Vehicle, 0.45f);
    h.probability[static_cast<std::size_t>(ObstacleClass::Unknown)] = 0.25f;
    h.probability[static_cast<std::size_t>(ObstacleClass::Structure)] = 0.3f;
    const Clusters clusters = sorted(h, cloud);
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_EQ(clusters.accepted[0].cls, ObstacleClass::Unknown);
}

TEST(SortGroups, ASmallPieceOfAVehicleIsUnknown) {
    const PointCloud cloud = boxCloud({4.0f, 1.8f, 1.5f}, 0.0f);
    for (const bool piece : {false, true}) {
        Hypothesis h = groupOf(allReturns(cloud));
        h.category[static_cast<std::size_t>(Category::Vehicle)] = piece ? 0.4f : 0.6f;
        h.category[static_cast<std::size_t>(Category::VehiclePart)] = piece ? 0.6f : 0.4f;
        const Clusters clusters = sorted(h, cloud);
        ASSERT_EQ(clusters.accepted.size(), 1u) << "a box it has";
        EXPECT_EQ(clusters.accepted[0].cls, piece ? ObstacleClass::Unknown : ObstacleClass::Vehicle);
        EXPECT_NEAR(clusters.accepted[0].probability[static_cast<std::size_t>(ObstacleClass::Vehicle)],
                    piece ? 0.4f : 1.0f, 1e-6f);
    }
}

TEST(SortGroups, WhatIsUnknownAndLikelySeveralThingsHasNoBoxOfItsOwn) {
    const PointCloud cloud = boxCloud({4.5f, 1.8f, 1.3f}, 0.2f);
    Hypothesis h = groupOf(allReturns(cloud), ObstacleClass::Unknown);
    h.whole = 0.4f;
    const Clusters mixture = sorted(h, cloud);
    EXPECT_TRUE(mixture.accepted.empty());
    ASSERT_EQ(mixture.structure.size(), 1u) << "small boxes follow it";
    EXPECT_EQ(mixture.structure[0].cls, ObstacleClass::Unknown);
    h.whole = 0.6f;
    EXPECT_EQ(sorted(h, cloud).accepted.size(), 1u);
}

TEST(SortGroups, TooFewReturnsAreNoise) {
    const PointCloud cloud = cloudOf({{10.0f, 0.0f, 1.0f}});
    EXPECT_EQ(rejectedFor(RejectReason::TooFewPoints, sorted(groupOf({0}), cloud)).measured, 1.0);
}

TEST(SortGroups, OfFewReturnsItIsNotToldWhatTheyAre) {
    const PointCloud cloud = boxCloud({4.0f, 1.8f, 1.5f}, 0.0f);
    std::vector<std::int32_t> few = {20, 40, 60};
    const Clusters three = sorted(groupOf(few), cloud);
    EXPECT_TRUE(three.accepted.empty());
    ASSERT_EQ(three.structure.size(), 1u) << "small boxes follow it";
    EXPECT_EQ(three.structure[0].cls, ObstacleClass::Unknown);
    few.pop_back();
    EXPECT_EQ(rejectedFor(RejectReason::TooFewPoints, sorted(groupOf(few), cloud)).limit, 3.0);
    GateParams params;
    params.min_points = 2;
    EXPECT_EQ(sorted(groupOf(few), cloud, params).accepted.size(), 1u) << "if so few are asked for";
}

TEST(SortGroups, WhatIsUnknownAndLongIsFollowedBySmallBoxes) {
    for (const float length : {5.5f, 6.5f}) {
        const PointCloud cloud = boxCloud({length, 1.8f, 1.5f}, 0.0f);
        const Clusters clusters = sorted(groupOf(allReturns(cloud), ObstacleClass::Unknown), cloud);
        EXPECT_EQ(clusters.structure.size(), length > kLongestStructureBox ? 1u : 0u) << length;
        EXPECT_EQ(clusters.accepted.size(), length > kLongestStructureBox ? 0u : 1u) << length;
    }
}

TEST(SortGroups, AKerbIsTooLow) {
    // at 3 m the next plane passes 3 * 0.035 = 0.1 m above the highest return: it would have met anything higher
    const PointCloud cloud = boxCloud({2.0f, 0.2f, 0.1f}, 0.02f, 3.0f);
    const RejectedCluster r = rejectedFor(RejectReason::TooLow, sorted(groupOf(allReturns(cloud)), cloud));
    EXPECT_LT(r.measured, r.limit);
    EXPECT_EQ(r.limit, GateParams{}.min_top);
}

TEST(SortGroups, WhatMayReachHigherThanItWasHitIsNotTooLow) {
    // the same 12 m away: the next plane passes 0.42 m above it
    const PointCloud cloud = boxCloud({2.0f, 0.2f, 0.1f}, 0.02f, 12.0f);
    const Clusters clusters = sorted(groupOf(allReturns(cloud)), cloud);
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_NEAR(clusters.accepted[0].top, 0.12f, 1e-5f);
    EXPECT_GT(clusters.accepted[0].max_top, 0.5f);
}

/// What is made of a thing .9 m high that lies .3 m below the model of the ground, among ground returns of that height.
Clusters belowTheModel(float ground_about) {
    PointCloud cloud = boxCloud({0.4f, 0.4f, 0.9f}, -1.2f, 6.0f);
    const std::vector<std::int32_t> thing = allReturns(cloud);
    for (int k = -4; k <= 4; ++k) cloud.xyz.emplace_back(5.7f, 0.15f * static_cast<float>(k), ground_about);
    GroundModel ground = knownGround(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        ground.height[i] = cloud.xyz[i].z();
        ground.is_ground[i] = i >= thing.size() ? 1 : 0;
    }
    SurfaceTops topOf(cloud, ground);
    return sortGroups({groupOf(thing)}, topOf, Beams(cloud), {});
}

TEST(SortGroups, WhatStandsOnGroundBelowTheModelIsNotTooLow) {
    EXPECT_EQ(belowTheModel(-1.2f).accepted.size(), 1u) << "on the far side of a ridge";
    rejectedFor(RejectReason::TooLow, belowTheModel(0.0f));  // a mirror image in wet asphalt
}

TEST(SortGroups, AWallIsFollowedUpwardsBeyondWhatIsInTheGroup) {
    World world = flatWorld();
    world.boxes = {boxAt(12.0, 0.0, 0.0, {2.0, 3.0, 6.0})};  // seen up to 1.8 + 11 * tan 15 deg = 4.7 m
    const Scan scan = castRays(world, Sensor{});
    std::vector<std::int32_t> lower;
    for (const std::int32_t i : scan.returnsOn(0))
        if (scan.cloud.xyz[i].z() < 2.5f) lower.push_back(i);
    const Clusters clusters = sorted(groupOf(lower), scan.cloud);
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_NEAR(clusters.accepted[0].top, 1.8 + 11.0 * std::tan(radians(15.0)), 0.1);
    EXPECT_EQ(clusters.accepted[0].points, lower) << "followed, not taken in";
}

TEST(SortGroups, ABranchOverACarIsNotPartOfIt) {
    World world = flatWorld();
    world.boxes = {carAt(12.0, 0.0, 0.0), {{14.0, 0.0, 4.0}, {3.0, 6.0, 1.0}, 0.0}};
    const Scan scan = castRays(world, Sensor{});
    const Clusters clusters = sorted(groupOf(scan.returnsOn(0)), scan.cloud);
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_LE(clusters.accepted[0].top, 1.51f);
}

}  // namespace
}  // namespace lidar_obstacles
