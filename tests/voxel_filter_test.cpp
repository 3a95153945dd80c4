// SPDX-License-Identifier: BSD-3-Clause
// What the filter for spurious returns keeps, drops, remembers and forgets.
#include "lidar_obstacles/voxel_filter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

const std::optional<Eigen::Isometry3d> kStanding = Eigen::Isometry3d::Identity();

std::vector<std::int32_t> allOf(const PointCloud& cloud) {
    std::vector<std::int32_t> all(cloud.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
}

/// How many of the points stay.
std::size_t kept(VoxelFilter& filter, const std::vector<Eigen::Vector3f>& points,
                 const std::optional<Eigen::Isometry3d>& pose = kStanding) {
    const PointCloud cloud = test::cloudOf(points);
    return filter.filter(cloud, allOf(cloud), pose).size();
}

OctomapParams params(int history, int min_hits) {
    OctomapParams p;
    p.history = history;
    p.min_hits = min_hits;
    return p;
}

TEST(VoxelFilter, FedNothingItKeepsNothing) {
    VoxelFilter filter(OctomapParams{});
    EXPECT_EQ(kept(filter, {}), 0u);
    EXPECT_EQ(kept(filter, {}, std::nullopt), 0u);
    EXPECT_EQ(filter.size(), 0u);
    EXPECT_TRUE(filter.supportingVoxels().empty());
}

TEST(VoxelFilter, ALoneReturnGoesAndThreeTogetherStay) {
    VoxelFilter filter(OctomapParams{});
    EXPECT_EQ(kept(filter, {{10, 0, 1}}), 0u);
    EXPECT_EQ(kept(filter, {{15, 0, 1}, {15, 0.1f, 1}, {15, 0, 1.2f}}), 3u);
}

TEST(VoxelFilter, NeighboursMayBeFartherApartFarAway) {
    VoxelFilter filter(OctomapParams{});
    const auto threeAt = [](float x) {
        return std::vector<Eigen::Vector3f>{{x, 0, 1}, {x, 0.5f, 1}, {x, 0.25f, 1.4f}};
    };
    EXPECT_EQ(kept(filter, threeAt(3)), 0u);
    EXPECT_EQ(kept(filter, threeAt(25)), 3u);
}

TEST(VoxelFilter, AVoxelsLifeFromTheFirstHitToForgetting) {
    VoxelFilter filter(params(5, 3));
    const std::vector<Eigen::Vector3f> lone{{10, 0, 1}};
    EXPECT_EQ(kept(filter, lone), 0u) << "first hit";
    EXPECT_EQ(kept(filter, lone), 0u);
    EXPECT_EQ(kept(filter, lone), 1u) << "three of the last five";
    EXPECT_EQ(filter.supportingVoxels().size(), 1u);
    EXPECT_TRUE(filter.supportingVoxels()[0].isApprox(Eigen::Vector3f(10.1f, 0.1f, 1.1f), 1e-4f));
    for (int k = 0; k < 3; ++k) kept(filter, {});
    EXPECT_EQ(kept(filter, lone), 0u) << "one of the three, and this one";
    for (int k = 0; k < 20; ++k) kept(filter, {});
    EXPECT_EQ(filter.size(), 0u) << "swept out";
}

TEST(VoxelFilter, NearTheSensorALoneReturnStaysLoneHoweverOften) {
    // planes of 2 deg are one voxel of 0.2 m apart at 5.7 m: nearer, rain hits the same voxel in every scan
    const auto keptInTheFifthScan = [](float x) {
        VoxelFilter filter(params(5, 3));
        const std::vector<Eigen::Vector3f> lone{{x, 0.1f, 1.8f}};
        for (int k = 0; k < 4; ++k) kept(filter, lone);
        return kept(filter, lone);
    };
    EXPECT_EQ(keptInTheFifthScan(3.0f), 0u);
    EXPECT_EQ(keptInTheFifthScan(5.5f), 0u);
    EXPECT_EQ(keptInTheFifthScan(6.0f), 1u);
}

TEST(VoxelFilter, EgoMotionIsUndone) {
    VoxelFilter filter(params(5, 3));
    std::size_t n = 0;
    for (int k = 0; k < 3; ++k) {  // a pole's lone return, 2 m nearer from scan to scan
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.translation().x() = 4.5e5 + 2.0 * k;  // far from the world's origin
        n = kept(filter, {{20.1f - 2.0f * static_cast<float>(k), 0.1f, 1.1f}}, pose);
    }
    EXPECT_EQ(n, 1u);
}

TEST(VoxelFilter, WithoutAPoseOnlyNeighboursCountAndNothingIsRemembered) {
    VoxelFilter filter(params(5, 2));
    for (int k = 0; k < 5; ++k) EXPECT_EQ(kept(filter, {{10, 0, 1}}, std::nullopt), 0u);
    EXPECT_EQ(filter.size(), 0u);
    EXPECT_EQ(kept(filter, {{10, 0, 1}, {10, 0.1f, 1}, {10, 0, 1.2f}}, std::nullopt), 3u);
}

TEST(VoxelFilter, AFaceAtFifteenMetresPerSecondStaysInEveryScan) {
    VoxelFilter filter(OctomapParams{});
    for (int k = 0; k < 8; ++k) {
        const test::World world{{test::GroundStrip{}}, {test::carAt(40.0 - 1.5 * k, 0.0, 180.0)}};
        const test::Scan scan = castRays(world, test::Sensor{});
        const auto on_car = scan.returnsOn(0);
        const auto stay = filter.filter(scan.cloud, on_car, kStanding);
        EXPECT_EQ(stay.size(), on_car.size()) << "scan " << k;
    }
}

TEST(VoxelFilter, ReturnsBeyondTheRangeAreKeptOrDroppedAsTheKeySays) {
    OctomapParams p;
    p.range = 20.0;
    const std::vector<Eigen::Vector3f> far{{30, 0, 1}};
    VoxelFilter keep(p);
    EXPECT_EQ(kept(keep, far), 1u);
    p.beyond = BeyondRange::Drop;
    VoxelFilter drop(p);
    EXPECT_EQ(kept(drop, far), 0u);
}

TEST(VoxelFilter, NeverHoldsMoreThanItsLimit) {
    OctomapParams p;
    p.max_voxels = 2000;
    VoxelFilter filter(p);
    std::mt19937 random(1);
    std::uniform_real_distribution<float> at(-30.0f, 30.0f);
    for (int scan = 0; scan < 50; ++scan) {
        std::vector<Eigen::Vector3f> rain;
        for (int k = 0; k < 1500; ++k) rain.emplace_back(at(random), at(random), 1.0f);
        kept(filter, rain);
        EXPECT_LE(filter.size(), 2000u);
    }
    const std::vector<Eigen::Vector3f> car{{15, 0, 1}, {15, 0.1f, 1}, {15, 0, 1.2f}};
    EXPECT_EQ(kept(filter, car), 3u) << "a full map does not hide what is there";
}

TEST(VoxelFilter, WhatStaysOfAScanDependsOnTheScansOfItsHistoryOnly) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> at(-3.0f, 3.0f);
    std::vector<std::vector<Eigen::Vector3f>> scans(60);
    for (auto& scan : scans)
        for (int k = 0; k < 300; ++k) scan.emplace_back(10.0f + at(random), at(random), 1.0f + 0.3f * at(random));
    const auto poseOf = [](std::size_t k) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.translation() = Eigen::Vector3d(4.5e5 + 0.37 * static_cast<double>(k), -5.1e6, 100.0);
        pose.rotate(Eigen::AngleAxisd(0.01 * static_cast<double>(k), Eigen::Vector3d::UnitZ()));
        return pose;
    };
    const OctomapParams few = params(5, 3);
    VoxelFilter from_the_start(few);
    std::size_t in_time = 0;
    for (std::size_t k = 0; k < scans.size(); ++k) {
        const PointCloud cloud = test::cloudOf(scans[k]);
        const auto stay = from_the_start.filter(cloud, allOf(cloud), poseOf(k));
        in_time += stay.size();
        if (k < 5) continue;
        VoxelFilter from_here(few);
        for (std::size_t j = k - 4; j < k; ++j) kept(from_here, scans[j], poseOf(j));
        EXPECT_EQ(from_here.filter(cloud, allOf(cloud), poseOf(k)), stay) << k;
    }
    EXPECT_GT(in_time, 0u);
}

TEST(VoxelFilter, ClearForgetsEverything) {
    VoxelFilter filter(params(5, 2));
    const std::vector<Eigen::Vector3f> lone{{10, 0, 1}};
    kept(filter, lone);
    filter.clear();
    EXPECT_EQ(filter.size(), 0u);
    EXPECT_EQ(kept(filter, lone), 0u);
}

}  // namespace
}  // namespace lidar_obstacles
