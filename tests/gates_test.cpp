// Every reason for which a cluster is no obstacle, reached by a cluster made for it.
#include <gtest/gtest.h>

#include "lidar_obstacles/clustering.h"
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

Clusters gate(const PointCloud& cloud, const GateParams& params = {}) {
    const GroundModel ground = knownGround(cloud);
    return gateClusters(cloud, ground, {clusterOf(allReturns(cloud), ground)}, params);
}

/// Expects that the only cluster is rejected, and tells with what.
RejectedCluster rejectedFor(RejectReason reason, const Clusters& clusters) {
    EXPECT_TRUE(clusters.accepted.empty());
    if (clusters.rejected.size() != 1) {
        ADD_FAILURE() << "accepted, not " << toString(reason);
        return {};
    }
    EXPECT_STREQ(toString(clusters.rejected[0].reason), toString(reason));
    return clusters.rejected[0];
}

TEST(Gates, NoClustersGiveNone) {
    const Clusters clusters = gateClusters(PointCloud{}, GroundModel{}, {}, GateParams{});
    EXPECT_TRUE(clusters.accepted.empty());
    EXPECT_TRUE(clusters.rejected.empty());
}

TEST(Gates, ACarPassesWithItsHeights) {
    const Clusters clusters = gate(boxCloud({4.5f, 1.8f, 1.3f}, 0.2f));
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_TRUE(clusters.rejected.empty());
    EXPECT_NEAR(clusters.accepted[0].bottom, 0.2f, 1e-5f);
    EXPECT_NEAR(clusters.accepted[0].top, 1.5f, 1e-5f);
}

TEST(Gates, APersonPasses) { EXPECT_EQ(gate(boxCloud({0.4f, 0.5f, 1.5f}, 0.2f)).accepted.size(), 1u); }

TEST(Gates, ALoneReturnIsTooFew) {
    const RejectedCluster r = rejectedFor(RejectReason::TooFewPoints, gate(cloudOf({{10.0f, 0.0f, 1.0f}})));
    EXPECT_EQ(r.measured, 1.0);
    EXPECT_EQ(r.limit, GateParams{}.min_points);
    EXPECT_EQ(r.cluster.points.size(), 1u);
}

TEST(Gates, AsManyReturnsAsTheLimitAreEnough) {
    GateParams params;
    params.min_points = 8;
    EXPECT_EQ(gate(boxCloud({1.0f, 1.0f, 0.1f}, 0.8f), params).accepted.size(), 1u);  // two layers of four
    params.min_points = 9;
    rejectedFor(RejectReason::TooFewPoints, gate(boxCloud({1.0f, 1.0f, 0.1f}, 0.8f), params));
}

TEST(Gates, ReturnsOnOneSpotAreTooSmall) {
    const PointCloud cloud = cloudOf(std::vector<Eigen::Vector3f>(8, {10.0f, 0.0f, 1.0f}));
    EXPECT_EQ(rejectedFor(RejectReason::TooSmall, gate(cloud)).measured, 0.0);
}

TEST(Gates, AKerbIsTooLow) {
    // at 3 m the next plane passes 3 * 0.035 = 0.1 m above the highest return: it would have met anything higher
    const RejectedCluster r = rejectedFor(RejectReason::TooLow, gate(boxCloud({2.0f, 0.2f, 0.1f}, 0.02f, 3.0f)));
    EXPECT_LT(r.measured, r.limit);
}

TEST(Gates, WhatBeginsAboveHeadHeightIsFloating) {
    const RejectedCluster r = rejectedFor(RejectReason::Floating, gate(boxCloud({2.0f, 1.0f, 0.5f}, 1.8f)));
    EXPECT_NEAR(r.measured, 1.8, 1e-5);
}

TEST(Gates, AWallIsTooLarge) {
    const RejectedCluster r = rejectedFor(RejectReason::TooLarge, gate(boxCloud({20.0f, 0.3f, 1.5f}, 0.2f)));
    EXPECT_NEAR(r.measured, 20.0, 0.01);
    EXPECT_EQ(r.limit, GateParams{}.max_length);
}

TEST(Gates, AShrubberyAsWideAsItIsLongIsTooLarge) {
    const RejectedCluster r = rejectedFor(RejectReason::TooLarge, gate(boxCloud({6.0f, 5.0f, 1.5f}, 0.2f)));
    EXPECT_NEAR(r.measured, 5.0, 0.01);
    EXPECT_EQ(r.limit, GateParams{}.max_width);
}

TEST(Gates, AHouseIsTooTall) {
    const RejectedCluster r = rejectedFor(RejectReason::TooTall, gate(boxCloud({3.0f, 3.0f, 5.0f}, 0.2f)));
    EXPECT_NEAR(r.measured, 5.2, 1e-4);
}

TEST(Gates, ATrunkIsAPole) {
    const RejectedCluster r = rejectedFor(RejectReason::Pole, gate(boxCloud({0.3f, 0.3f, 3.0f}, 0.2f)));
    EXPECT_NEAR(r.measured, 3.2, 1e-4);
}

TEST(Gates, AWallIsFollowedUpwardsBeyondWhatIsInTheCluster) {
    World world = flatWorld();
    world.boxes = {boxAt(12.0, 0.0, 0.0, {2.0, 3.0, 6.0})};  // seen up to 1.8 + 11 * tan 15 deg = 4.7 m
    const Scan scan = castRays(world, Sensor{});
    const GroundModel ground = knownGround(scan);
    Cluster lower;
    for (const std::int32_t i : scan.returnsOn(0))
        if (ground.height[i] < 2.5f) lower.points.push_back(i);
    const RejectedCluster r =
        rejectedFor(RejectReason::TooTall, gateClusters(scan.cloud, ground, {lower}, GateParams{}));
    EXPECT_NEAR(r.measured, 1.8 + 11.0 * std::tan(radians(15.0)), 0.1);
    EXPECT_EQ(r.cluster.points, lower.points) << "followed, not taken in";
}

TEST(Gates, ABranchOverACarIsNotPartOfIt) {
    World world = flatWorld();
    world.boxes = {carAt(12.0, 0.0, 0.0), {{14.0, 0.0, 4.0}, {3.0, 6.0, 1.0}, 0.0}};
    const Scan scan = castRays(world, Sensor{});
    const GroundModel ground = knownGround(scan);
    Cluster car;
    car.points = scan.returnsOn(0);
    const Clusters clusters = gateClusters(scan.cloud, ground, {car}, GateParams{});
    ASSERT_EQ(clusters.accepted.size(), 1u);
    EXPECT_LE(clusters.accepted[0].top, 1.51f);
}

}  // namespace
}  // namespace lidar_obstacles
