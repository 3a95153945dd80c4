// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lidar_obstacles/simulation/ground.h"
#include "support/small_worlds.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

TrackSpec straightTrack(double length = 400.0) {
    TrackSpec spec;
    spec.segments = {{length, 0.0}};
    return spec;
}

std::shared_ptr<const Track> straight() { return std::make_shared<const Track>(straightTrack()); }

TEST(Curve, GoesThroughItsKnotsAndNeverBeyondThem) {
    const Curve curve({{0.0, 0.0}, {1.0, 0.0}, {2.0, 5.0}, {3.0, 5.0}, {5.0, 1.0}});
    EXPECT_DOUBLE_EQ(curve(2.0), 5.0);
    EXPECT_DOUBLE_EQ(curve(-1.0), 0.0);
    EXPECT_DOUBLE_EQ(curve(9.0), 1.0);
    for (double x = 0.0; x <= 5.0; x += 0.01) {
        EXPECT_GE(curve(x), -1e-12);
        EXPECT_LE(curve(x), 5.0 + 1e-12);
        if (x <= 1.0) {
            EXPECT_DOUBLE_EQ(curve(x), 0.0);
        }
    }
}

TEST(Curve, OfTwoKnotsIsALine) {
    EXPECT_NEAR(Curve(std::vector<Curve::Knot>{{0.0, 1.0}, {4.0, 9.0}})(1.5), 4.0, 1e-12);
}

TEST(Curve, RefusesKnotsThatDoNotRise) {
    EXPECT_THROW(Curve(std::vector<Curve::Knot>{{1.0, 0.0}, {1.0, 2.0}}), std::invalid_argument);
    EXPECT_THROW(Curve(std::vector<Curve::Knot>{}), std::invalid_argument);
}

TEST(Track, ACircleHasItsRadius) {
    TrackSpec spec;
    spec.closed = true;
    spec.segments = {{2.0 * M_PI * 50.0, 2.0 * M_PI}};
    const Track track(spec);
    for (double s = 0.0; s < 700.0; s += 13.0) {
        EXPECT_NEAR((track.at(s).position - Eigen::Vector2d(0.0, 50.0)).norm(), 50.0, 1e-3);
        EXPECT_NEAR((track.place(s, 5.0) - Eigen::Vector2d(0.0, 50.0)).norm(), 45.0, 1e-3);
    }
    EXPECT_LT((track.at(0.0).position - track.at(track.length()).position).norm(), 1e-6);
}

TEST(Track, ALapThatDoesNotCloseIsRefused) {
    TrackSpec spec = straightTrack();
    spec.closed = true;
    EXPECT_THROW(Track{spec}, std::invalid_argument);
}

TEST(Path, LooksWhereItGoes) {
    const Path path(straight(), {{0.0, 10.0, 0.0}, {10.0, 30.0, 20.0}});
    EXPECT_NEAR(path.at(5.0).yaw, 45.0 * kDegree, 1e-6);
    EXPECT_TRUE(path.isMoving(5.0));
}

TEST(Path, KeepsItsYawWhereItWaits) {
    // Across the road, a wait, back along it.
    const Path path(straight(), {{0.0, 10.0, -5.0}, {5.0, 10.0, 5.0}, {10.0, 10.0, 5.0}, {20.0, 0.0, 5.0}});
    EXPECT_NEAR(path.at(4.99).yaw, 90.0 * kDegree, 1e-3);
    EXPECT_NEAR(path.at(7.0).yaw, 90.0 * kDegree, 1e-3);
    EXPECT_FALSE(path.isMoving(7.0));
    EXPECT_NEAR(std::abs(path.at(15.0).yaw), 180.0 * kDegree, 1e-3);
    EXPECT_NEAR(std::abs(path.at(30.0).yaw), 180.0 * kDegree, 1e-3);
    EXPECT_NEAR(path.at(-1.0).yaw, 90.0 * kDegree, 1e-3);
}

TEST(Path, WithoutAnyTravelLooksAlongTheTrack) {
    EXPECT_DOUBLE_EQ(Path(straight(), {{0.0, 10.0, 3.0}}).at(1.0).yaw, 0.0);
}

TEST(Path, FollowsAnother) {
    const Path lead(straight(), {{0.0, 0.0, 0.0}, {10.0, 100.0, 0.0}});
    const Path path(straight(), {{0.0, 20.0, 1.0}, {10.0, 10.0, 1.0}}, lead.along());
    EXPECT_NEAR(path.position(5.0).x(), 65.0, 1e-9);
    EXPECT_NEAR(path.at(5.0).yaw, 0.0, 1e-9);
}

TEST(GridPoses, PutTheNearestPointAtTheRange) {
    const Gridded grid{{3.0, 20.0}, {0.0, 70.0 * kDegree}, {0.0, 25.0 * kDegree, 90.0 * kDegree}};
    const Eigen::Vector2d box(4.6, 1.8);
    const PosePerScan poses = gridPoses(grid, {}, box);
    ASSERT_EQ(poses.poses.size(), 12U);
    for (std::size_t i = 0; i < poses.poses.size(); ++i) {
        const PlanarPose& pose = poses.poses[i];
        const Eigen::Vector2d local = Eigen::Rotation2Dd(-pose.yaw) * pose.position;
        EXPECT_NEAR((local.cwiseAbs() - 0.5 * box).cwiseMax(0.0).norm(), i < 6 ? 3.0 : 20.0, 1e-6);
        EXPECT_NEAR(std::atan2(pose.position.y(), pose.position.x()), i % 6 < 3 ? 0.0 : 70.0 * kDegree, 1e-6);
    }
}

TEST(Ground, AVehicleLeansWithBankAndSlope) {
    TrackSpec spec = straightTrack();
    spec.width = 30.0;
    spec.elevation = Curve(std::vector<Curve::Knot>{{0.0, 0.0}, {400.0, 40.0}});
    spec.bank = Curve(4.0 * kDegree);
    const Track track(spec);
    const Ground ground(terrainMesh(track, TerrainSpec{}));
    const Pose6 pose = standOn(ground, {{200.0, 3.0}, 0.0}, {2.7, 1.5});
    EXPECT_NEAR(pose.pitch, -std::atan(0.1), 1e-3);  // nose up
    EXPECT_NEAR(pose.roll, 4.0 * kDegree, 1e-3);
    EXPECT_NEAR(pose.position.z(), 20.0 + 3.0 * std::tan(4.0 * kDegree), 0.01);
}

TEST(Ground, SidewalksAndRampsCarryWhatStandsOnThem) {
    const World world = test::worldOf(
        {"clutter: [{type: sidewalk, from: 50, to: 150, d: 8, width: 3, height: 0.15}, {type: ramp, s: 100, d: -5, "
         "length: 10, width: 4, height: 1}]\n"});
    EXPECT_NEAR(*world.ground->heightAt({100.0, 8.0}), 0.15, 1e-3);
    EXPECT_NEAR(*world.ground->heightAt({100.0, -5.0}), 1.0, 1e-3);
    EXPECT_NEAR(*world.ground->heightAt({97.0, -5.0}), 0.5, 1e-3);  // half way up
    EXPECT_NEAR(*world.ground->heightAt({100.0, 0.0}), 0.0, 1e-3);
    EXPECT_FALSE(world.ground->heightAt({100.0, 500.0}));
}

}  // namespace
}  // namespace lidar_obstacles::simulation
