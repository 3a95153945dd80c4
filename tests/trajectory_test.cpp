// SPDX-License-Identifier: BSD-3-Clause
// Poses over time, and de-skewing by them.
#include "lidar_obstacles/motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "lidar_obstacles/deskew.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

using test::radians;

StampedPose poseAt(double time, double x, double yaw_deg = 0.0) {
    StampedPose pose;
    pose.time = time;
    pose.position.x() = x;
    pose.orientation = Eigen::AngleAxisd(radians(yaw_deg), Eigen::Vector3d::UnitZ());
    return pose;
}

double yawOf(const PoseAt& pose) {
    const Eigen::Vector3d ahead = pose.T_world_vehicle->linear().col(0);
    return std::atan2(ahead.y(), ahead.x());
}

/// A pose every .05 s from 0 on, at 1 m/s.
Trajectory fiveSeconds() {
    Trajectory t;
    for (int k = 0; k < 100; ++k) t.add(poseAt(0.05 * k, 0.05 * k));
    return t;
}

TEST(Trajectory, AtAStampItIsThePoseOfThatStamp) {
    Trajectory t;
    t.add(poseAt(10.0, 1.0, 20.0));
    t.add(poseAt(10.1, 2.0, 30.0));
    for (const auto& [time, x, yaw] : {std::tuple{10.0, 1.0, 20.0}, std::tuple{10.1, 2.0, 30.0}}) {
        const PoseAt pose = t.at(time);
        EXPECT_EQ(pose.found, PoseFound::At);
        EXPECT_NEAR(pose.T_world_vehicle->translation().x(), x, 1e-12);
        EXPECT_NEAR(yawOf(pose), radians(yaw), 1e-12);
    }
}

TEST(Trajectory, BetweenStampsItIsInterpolatedByTime) {
    Trajectory t;
    t.add(poseAt(0.0, 0.0, 0.0));
    t.add(poseAt(0.2, 2.0, 10.0));
    const PoseAt pose = t.at(0.05);
    EXPECT_EQ(pose.found, PoseFound::At);
    EXPECT_NEAR(pose.T_world_vehicle->translation().x(), 0.5, 1e-12);
    EXPECT_NEAR(yawOf(pose), radians(2.5), 1e-12);
}

TEST(Trajectory, ATurnThroughHalfACircleTakesTheShortWay) {
    Trajectory t;
    t.add(poseAt(0.0, 0.0, 178.0));
    t.add(poseAt(0.1, 0.0, -178.0));
    EXPECT_NEAR(std::abs(yawOf(t.at(0.05))), M_PI, 1e-9);
    EXPECT_NEAR(yawOf(t.at(0.025)), radians(179.0), 1e-9);
}

TEST(Trajectory, TheOrderInWhichPosesComeDoesNotMatter) {
    Trajectory sorted, shuffled;
    for (const int k : {0, 1, 2, 3, 4}) sorted.add(poseAt(0.1 * k, 1.0 * k * k));
    for (const int k : {3, 0, 4, 2, 1}) EXPECT_TRUE(shuffled.add(poseAt(0.1 * k, 1.0 * k * k)));
    for (double time = 0.0; time <= 0.4; time += 0.01)
        EXPECT_EQ(sorted.at(time).T_world_vehicle->matrix(), shuffled.at(time).T_world_vehicle->matrix());
}

TEST(Trajectory, OfTwoPosesWithOneStampTheFirstStays) {
    Trajectory t;
    EXPECT_TRUE(t.add(poseAt(1.0, 5.0)));
    EXPECT_FALSE(t.add(poseAt(1.0, 6.0)));
    EXPECT_EQ(t.size(), 1u);
    EXPECT_DOUBLE_EQ(t.at(1.0).T_world_vehicle->translation().x(), 5.0);
}

TEST(Trajectory, WithoutPosesThereIsNone) {
    EXPECT_EQ(Trajectory().at(1.0).found, PoseFound::NoPoses);
    EXPECT_FALSE(Trajectory().at(1.0).T_world_vehicle);
}

TEST(Trajectory, AGapIsNotBridged) {
    EgoParams params;
    params.max_gap = 0.3;
    Trajectory t(params);
    for (const double time : {0.0, 0.1, 0.9, 1.0}) t.add(poseAt(time, 10.0 * time));
    EXPECT_EQ(t.at(0.5).found, PoseFound::Gap);
    EXPECT_FALSE(t.at(0.5).T_world_vehicle);
    EXPECT_EQ(t.at(0.95).found, PoseFound::At);
    EXPECT_TRUE(t.brokenBetween(0.05, 0.95));
    EXPECT_FALSE(t.brokenBetween(0.0, 0.1));
    EXPECT_FALSE(t.brokenBetween(0.9, 1.0));
}

TEST(Trajectory, AJumpIsToldAndNothingIsInterpolatedAcrossIt) {
    Trajectory t;
    for (const double time : {0.0, 0.1, 0.2}) t.add(poseAt(time, time));
    for (const double time : {0.3, 0.4}) t.add(poseAt(time, 50.0 + time));
    EXPECT_EQ(t.at(0.25).found, PoseFound::Jump);
    EXPECT_EQ(t.at(0.35).found, PoseFound::At);
    EXPECT_TRUE(t.brokenBetween(0.1, 0.4));
}

TEST(Trajectory, AJoltOfTheTiltIsNoJumpButOneOfTheHeadingIs) {
    for (const auto& [axis, jump] :
         {std::pair{Eigen::Vector3d(1, 0, 0), false}, std::pair{Eigen::Vector3d(0, 1, 0), false},
          std::pair{Eigen::Vector3d(0, 0, 1), true}}) {
        Trajectory t;
        t.add(poseAt(0.0, 0.0, 30.0));
        StampedPose on_the_kerb = poseAt(0.05, 0.05, 30.0);
        on_the_kerb.orientation = Eigen::AngleAxisd(radians(14.0), axis) * on_the_kerb.orientation;
        t.add(on_the_kerb);
        EXPECT_EQ(t.brokenBetween(0.0, 0.05), jump) << axis.transpose();
    }
}

TEST(Trajectory, BeyondTheLastPoseItGoesOnAtConstantVelocityUpToTheLimit) {
    EgoParams params;
    params.max_extrapolation = 0.1;
    Trajectory t(params);
    for (int k = 0; k <= 4; ++k) t.add(poseAt(0.05 * k, 0.5 * k, 1.0 * k));
    const PoseAt pose = t.at(0.25);
    EXPECT_EQ(pose.found, PoseFound::Extrapolated);
    EXPECT_NEAR(pose.T_world_vehicle->translation().x(), 2.5, 1e-9);
    EXPECT_NEAR(yawOf(pose), radians(5.0), 1e-9);
    EXPECT_EQ(t.at(0.31).found, PoseFound::Outside);
    EXPECT_EQ(t.at(-0.01).found, PoseFound::Outside) << "nothing is told about before the first";
}

TEST(Trajectory, ASinglePoseIsNoMotion) {
    Trajectory t;
    t.add(poseAt(0.0, 1.0));
    EXPECT_EQ(t.at(0.0).found, PoseFound::At);
    EXPECT_EQ(t.at(0.05).found, PoseFound::Outside);
}

TEST(Trajectory, APoseThatIsNotFiniteIsRefusedWithItsStamp) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    Trajectory t;
    t.add(poseAt(1.5, 1.0));
    StampedPose bad = poseAt(2.5, kNan);
    try {
        t.add(bad);
        FAIL() << "not refused";
    } catch (const std::invalid_argument& e) {
        EXPECT_THAT(e.what(), testing::AllOf(testing::HasSubstr("2.5"), testing::HasSubstr("not finite")));
    }
    bad = poseAt(2.5, 1.0);
    bad.orientation.coeffs().setZero();
    EXPECT_THROW(t.add(bad), std::invalid_argument);
    EXPECT_THROW(t.add(poseAt(kNan, 1.0)), std::invalid_argument);
    EXPECT_EQ(t.size(), 1u);
}

TEST(Trajectory, OldPosesAreForgottenButTheTwoThatInterpolationNeeds) {
    Trajectory t = fiveSeconds();
    t.forgetBefore(4.0);
    EXPECT_LE(t.size(), 22u);
    EXPECT_EQ(t.at(3.98).found, PoseFound::At);
}

TEST(Trajectory, PosesOfAClockThatWasSetBackAreForgotten) {
    Trajectory t = fiveSeconds();
    t.forgetAfter(1.0);
    EXPECT_EQ(t.size(), 21u);
    EXPECT_EQ(t.at(1.0).found, PoseFound::At);
    t.forgetAfter(-1.0);
    EXPECT_TRUE(t.empty());
}

/// A scan of the world as a vehicle sees it that drives and turns: each column from where it is then.
PointCloud skewedScan(const test::World& world, const Trajectory& trajectory, double turn) {
    test::Sensor sensor;
    PointCloud cloud = castRays(world, sensor).cloud;  // seen from the world's origin
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto offset = static_cast<float>(turn * cloud.view.column_of[i] / cloud.view.columns);
        cloud.time_offset.push_back(offset);
        cloud.xyz[i] = (trajectory.at(offset).T_world_vehicle->inverse() * cloud.xyz[i].cast<double>()).cast<float>();
    }
    return cloud;
}

TEST(Deskew, PutsEachReturnWhereItIsAtTheReferenceTime) {
    Trajectory t;  // 20 m/s and 30 deg/s
    for (int k = 0; k <= 4; ++k) t.add(poseAt(0.05 * k, 1.0 * k, 1.5 * k));
    const PointCloud truth = castRays(test::street(), test::Sensor{}).cloud;
    const PointCloud skewed = skewedScan(test::street(), t, 0.1);
    const Deskewed result = deskew(skewed, t);
    EXPECT_EQ(result.how, Deskewing::Done);
    float worst = 0.0f, before = 0.0f;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        worst = std::max(worst, (result.cloud.xyz[i] - truth.xyz[i]).norm());
        before = std::max(before, (skewed.xyz[i] - truth.xyz[i]).norm());
    }
    EXPECT_GT(before, 2.0f);
    // half a step of 0.2 ms: 2 mm of way and 0.003 deg, 5 mm at 100 m
    EXPECT_LT(worst, 0.008f);
}

TEST(Deskew, IsNotAppliedWithoutPointTimes) {
    Trajectory t;
    t.add(poseAt(0.0, 0.0));
    t.add(poseAt(0.2, 4.0));
    const PointCloud cloud = castRays(test::street(), test::Sensor{}).cloud;
    const Deskewed result = deskew(cloud, t);
    EXPECT_EQ(result.how, Deskewing::NoPointTimes);
    EXPECT_EQ(result.cloud.xyz, cloud.xyz);
}

TEST(Deskew, LeavesTheScanAloneWhereThePosesDoNotCoverIt) {
    Trajectory t;
    for (int k = 0; k <= 4; ++k) t.add(poseAt(0.05 * k, 1.0 * k));
    PointCloud cloud = skewedScan(test::street(), t, 0.1);
    EgoParams strict;
    strict.max_extrapolation = 0.0;
    Trajectory too_short(strict);
    too_short.add(poseAt(0.0, 0.0));
    too_short.add(poseAt(0.05, 1.0));
    const Deskewed result = deskew(cloud, too_short);
    EXPECT_EQ(result.how, Deskewing::NoMotion);
    EXPECT_EQ(result.poses, PoseFound::Outside);
    EXPECT_EQ(result.cloud.xyz, cloud.xyz);
    EXPECT_EQ(deskew(cloud, Trajectory{}).poses, PoseFound::NoPoses);
}

TEST(Deskew, NothingStaysNothing) {
    const Deskewed result = deskew(PointCloud{}, Trajectory{});
    EXPECT_EQ(result.how, Deskewing::Done);
    EXPECT_TRUE(result.cloud.empty());
}

}  // namespace
}  // namespace lidar_obstacles
