// SPDX-License-Identifier: BSD-3-Clause
// Poses of the vehicle from what rawlogs hold.
#include "lidar_obstacles/mrpt_bridge/ego_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <limits>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using namespace mrpt::obs;
using test::Objects;

constexpr double kStart = 1'000'000.0;

mrpt::Clock::time_point stampAt(double seconds) { return mrpt::Clock::fromDouble(kStart + seconds); }

CObservationRobotPose::Ptr poseAt(double time, double x, double yaw = 0.0) {
    auto o = CObservationRobotPose::Create();
    o->sensorLabel = "rtk";
    o->timestamp = stampAt(time);
    o->pose.mean = mrpt::poses::CPose3D(x, 1, 2, yaw, 0.02, -0.03);
    return o;
}

CObservationOdometry::Ptr odometryAt(double time, double x) {
    auto o = CObservationOdometry::Create();
    o->sensorLabel = "wheels";
    o->timestamp = stampAt(time);
    o->odometry = mrpt::poses::CPose2D(x, 0, 0.1);
    return o;
}

CObservationIMU::Ptr rateAt(double time, double yaw_rate) {
    auto o = CObservationIMU::Create();
    o->sensorLabel = "imu";
    o->timestamp = stampAt(time);
    for (const auto& [field, value] : {std::pair{IMU_WX, 0.0}, std::pair{IMU_WY, 0.0}, std::pair{IMU_WZ, yaw_rate}}) {
        o->dataIsPresent[field] = true;
        o->rawMeasurements[field] = value;
    }
    return o;
}

CObservationGPS::Ptr fixAt(double time, double latitude_deg, double course_deg, double knots) {
    auto o = CObservationGPS::Create();
    o->sensorLabel = "gps";
    o->timestamp = stampAt(time);
    gnss::Message_NMEA_RMC rmc;
    rmc.fields.validity_char = 'A';
    rmc.fields.latitude_degrees = latitude_deg;
    rmc.fields.longitude_degrees = 9.0;
    rmc.fields.direction_degrees = course_deg;
    rmc.fields.speed_knots = knots;
    o->setMsg(rmc);
    return o;
}

CActionCollection::Ptr stepOf(double x, std::optional<double> time) {
    CActionRobotMovement2D move;
    move.computeFromOdometry(mrpt::poses::CPose2D(x, 0, 0), {});
    move.timestamp = time ? stampAt(*time) : mrpt::Clock::time_point(INVALID_TIMESTAMP);
    auto actions = CActionCollection::Create();
    actions->insert(move);
    return actions;
}

std::string fileOf(const test::TempFolder& folder, const Objects& objects) {
    const std::string path = folder.file("drive.rawlog");
    test::writeRawlog(path, objects, true);
    return path;
}

std::vector<StampedPose> posesOf(const std::string& path, const EgoSource& source) {
    std::vector<StampedPose> poses;
    EgoMotion motion(source);
    const auto in = openScanSource(path);
    while (const auto item = in->next())
        if (const auto pose = motion.poseOf(*item)) poses.push_back(*pose);
    return poses;
}

double yawOf(const StampedPose& pose) {
    const Eigen::Vector3d ahead = pose.orientation * Eigen::Vector3d::UnitX();
    return std::atan2(ahead.y(), ahead.x());
}

TEST(EgoMotion, ARobotPoseIsTakenAsItStands) {
    const test::TempFolder folder;
    const auto poses = posesOf(fileOf(folder, {poseAt(0.5, 7.0, 0.4)}), {EgoKind::Pose, "rtk"});
    ASSERT_EQ(poses.size(), 1u);
    EXPECT_NEAR(poses[0].time, kStart + 0.5, 1e-6);
    EXPECT_EQ(poses[0].position, Eigen::Vector3d(7, 1, 2));
    const mrpt::poses::CPose3D mrpt_pose(7, 1, 2, 0.4, 0.02, -0.03);
    const auto there = mrpt_pose.composePoint({1, 2, 3});  // MRPT's own composition is the judge
    const Eigen::Vector3d p = poses[0].position + poses[0].orientation * Eigen::Vector3d(1, 2, 3);
    EXPECT_NEAR((p - Eigen::Vector3d(there.x, there.y, there.z)).norm(), 0.0, 1e-12);
}

TEST(EgoMotion, AutoTakesPosesBeforeOdometryAndOdometryBeforeRates) {
    const test::TempFolder folder;
    const auto kindIn = [&](const Objects& objects) { return chooseEgoSource(fileOf(folder, objects), "auto").kind; };
    EXPECT_EQ(kindIn({rateAt(0, 0), odometryAt(0, 0), poseAt(0, 0)}), EgoKind::Pose);
    EXPECT_EQ(kindIn({rateAt(0, 0), odometryAt(0, 0)}), EgoKind::Odometry);
    EXPECT_EQ(kindIn({rateAt(0, 0), fixAt(0, 45, 90, 20)}), EgoKind::Gps);
    EXPECT_EQ(kindIn({rateAt(0, 0)}), EgoKind::Imu);
    EXPECT_EQ(kindIn({stepOf(1, 0.0)}), EgoKind::Actions);
    EXPECT_EQ(kindIn({test::scanLabelled("front")}), EgoKind::None);
    EXPECT_EQ(kindIn({fixAt(0, 45, 90, 0.1)}), EgoKind::None) << "a course at standstill is no heading";
}

TEST(EgoMotion, ALabelChoosesAndAnUnknownOneIsAnErrorThatListsWhatIsThere) {
    const test::TempFolder folder;
    const std::string path = fileOf(folder, {odometryAt(0, 0), poseAt(0, 0)});
    EXPECT_EQ(chooseEgoSource(path, "wheels").kind, EgoKind::Odometry);
    EXPECT_EQ(chooseEgoSource(path, "none").kind, EgoKind::None);
    try {
        chooseEgoSource(path, "rkt");
        FAIL();
    } catch (const std::invalid_argument& e) {
        EXPECT_THAT(e.what(), testing::AllOf(testing::HasSubstr("rkt"), testing::HasSubstr("'rtk' (pose)"),
                                             testing::HasSubstr("'wheels' (odometry)")));
    }
}

TEST(EgoMotion, ActionsAddUpAndTakeTheNextStampWhereTheyHaveNone) {
    const test::TempFolder folder;
    const std::string path =
        fileOf(folder, {stepOf(1.0, 0.1), stepOf(2.0, std::nullopt), odometryAt(0.2, 0), odometryAt(0.3, 0)});
    const auto poses = posesOf(path, {EgoKind::Actions, "actions"});
    ASSERT_EQ(poses.size(), 2u);
    EXPECT_NEAR(poses[0].position.x(), 1.0, 1e-9);
    EXPECT_NEAR(poses[1].position.x(), 3.0, 1e-9);
    EXPECT_NEAR(poses[1].time, kStart + 0.2, 1e-6);
}

TEST(EgoMotion, RatesAreSummedUpIntoTheVehicleFrame) {
    auto tilted = rateAt(0.1, 0.5);
    tilted->sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, 0, M_PI);  // upside down: it turns the other way
    EgoMotion upright({EgoKind::Imu, "imu"}), upside_down({EgoKind::Imu, "imu"});
    upright.poseOf({rateAt(0.0, 0.5), nullptr, 0});
    upside_down.poseOf({rateAt(0.0, 0.5), nullptr, 0});
    const auto a = upright.poseOf({rateAt(0.1, 0.5), nullptr, 1});
    const auto b = upside_down.poseOf({tilted, nullptr, 1});
    ASSERT_TRUE(a && b);
    EXPECT_TRUE(a->rotation_only);
    EXPECT_NEAR(yawOf(*a), 0.05, 1e-6);
    EXPECT_NEAR(yawOf(*b), -0.05, 1e-6);
    EXPECT_FALSE(upright.poseOf({rateAt(0.05, 9.0), nullptr, 2})) << "came late";
}

TEST(EgoMotion, RatesOfAClockThatIsSetBackGoOn) {
    EgoMotion motion({EgoKind::Imu, "imu"});
    std::size_t object = 0;
    ASSERT_TRUE(motion.poseOf({rateAt(100.0, 0.5), nullptr, object++}));
    EXPECT_FALSE(motion.poseOf({rateAt(99.9, 0.5), nullptr, object++})) << "came late";
    ASSERT_TRUE(motion.poseOf({rateAt(10.0, 0.5), nullptr, object++}));
    const auto pose = motion.poseOf({rateAt(10.1, 0.5), nullptr, object++});
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->time - kStart, 10.1, 1e-6);
}

TEST(EgoMotion, GpsIsEastNorthUpWithTheCourseAsHeading) {
    EgoMotion motion({EgoKind::Gps, "gps"});
    const auto first = motion.poseOf({fixAt(0, 45.0, 90, 20), nullptr, 0});
    const auto second = motion.poseOf({fixAt(1, 45.0 + 1e-4, 0, 20), nullptr, 1});
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->position, Eigen::Vector3d::Zero());
    EXPECT_NEAR(yawOf(*first), 0.0, 1e-9) << "east";
    EXPECT_NEAR(second->position.x(), 0.0, 1e-6);
    EXPECT_NEAR(second->position.y(), 11.113, 0.005) << "a degree of latitude at 45 deg is 111.13 km";
    EXPECT_NEAR(yawOf(*second), M_PI / 2, 1e-9) << "north";
    EXPECT_FALSE(motion.poseOf({fixAt(5, 45.0, 0, 0.1), nullptr, 2})) << "the last heading is too old";
}

TEST(EgoMotion, AVehicleThatStopsKeepsItsHeading) {
    EgoMotion motion({EgoKind::Gps, "gps"});
    for (std::size_t k = 0; k < 30; ++k) {
        const double course = k < 10 ? 90.0 : 7.0 * static_cast<double>(k);  // at standstill it is noise
        const auto pose =
            motion.poseOf({fixAt(0.1 * static_cast<double>(k), 45.0, course, k < 10 ? 20 : 0.2), nullptr, k});
        ASSERT_TRUE(pose) << k;
        EXPECT_NEAR(yawOf(*pose), 0.0, 1e-9) << k;
    }
    EXPECT_FALSE(motion.poseOf({fixAt(5.0, 45.0, 0, 0.2), nullptr, 30})) << "it may have turned meanwhile";
}

TEST(PoseFeed, APoseBeyondTheEndOfAScanIsThereBeforeTheScan) {
    const test::TempFolder folder;
    Objects objects;
    for (int k = 0; k < 30; ++k) {
        if (k % 2 == 0) objects.push_back(test::scanLabelled("front", kStart + 0.05 * k));
        objects.push_back(poseAt(0.05 * k, k));
    }
    const auto source = openScanSource(fileOf(folder, objects));
    Trajectory trajectory;
    PoseFeed feed(*source, {EgoKind::Pose, "rtk"}, [&](const StampedPose& p) { trajectory.add(p); });
    std::size_t items = 0, interpolated = 0, scans = 0;
    while (const auto item = feed.next()) {
        EXPECT_EQ(item->object, items++) << "order is kept";
        EXPECT_EQ(feed.objects(), items);
        if (!isLidarScan(*item->observation)) continue;
        ++scans;
        const double end = mrpt::Clock::toDouble(item->observation->timestamp) + 0.1;
        interpolated += trajectory.at(end).found == PoseFound::At;
    }
    EXPECT_EQ(items, objects.size());
    EXPECT_EQ(scans, 15u);
    EXPECT_GE(interpolated, 14u) << "all but the last";
    EXPECT_EQ(feed.poses(), 30u);
    EXPECT_EQ(feed.status(), SourceStatus::End);
}

TEST(PoseFeed, AClockThatIsSetBackCostsAScanOnly) {
    const test::TempFolder folder;
    Objects objects;
    for (const double begin : {100.0, 40.0}) {
        for (int k = 0; k < 60; ++k) {
            objects.push_back(poseAt(begin + 0.05 * k, begin + 0.2 * k));
            if (k % 2 == 0) objects.push_back(test::scanLabelled("front", kStart + begin + 0.05 * k + 0.02));
        }
    }
    const auto source = openScanSource(fileOf(folder, objects));
    DetectorParams params;
    params.deskew.enabled = true;
    ObstacleDetector detector(params);
    PoseFeed feed(*source, {EgoKind::Pose, "rtk"}, [&](const StampedPose& p) { detector.addPose(p); });
    int scans = 0, at = 0;
    while (const auto item = feed.next()) {
        if (!isLidarScan(*item->observation)) continue;
        ++scans;
        at += static_cast<int>(detector.process(*toPointCloud(*item->observation, {})).pose == PoseFound::At);
        const double end = mrpt::Clock::toDouble(item->observation->timestamp) + 0.1;
        if (scans > 31 && scans < 58) {
            EXPECT_EQ(detector.trajectory().at(end).found, PoseFound::At) << scans;
        }
    }
    EXPECT_EQ(scans, 60);
    EXPECT_GE(at, 58);
}

TEST(PoseFeed, PosesThatAreNotFiniteAreRefusedAndToldAbout) {
    const test::TempFolder folder;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto source = openScanSource(fileOf(folder, {poseAt(0.0, 0.0), poseAt(0.1, nan), poseAt(0.2, 1.0)}));
    ObstacleDetector detector(DetectorParams{});
    PoseFeed feed(*source, {EgoKind::Pose, "rtk"}, [&](const StampedPose& p) { detector.addPose(p); });
    while (feed.next()) {
    }
    EXPECT_EQ(feed.poses(), 2u);
    EXPECT_EQ(feed.refused(), 1u);
    EXPECT_THAT(feed.remarks(),
                testing::AllOf(testing::HasSubstr("1 poses of 'rtk' refused"), testing::HasSubstr("not finite")));
}

}  // namespace
}  // namespace lidar_obstacles
