// SPDX-License-Identifier: BSD-3-Clause
// The detector on a rawlog in one call: scans, poses, tracks, and what is an error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/testing/matchers.h"
#include "lidar_obstacles/testing/rawlog.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

/// Eight simulated scans, 2 s apart; the first with a truck at (10.1, -3.6).
const char* const kSample = STREET_SAMPLE;

TEST(DetectRawlog, FindsWhatStandsInTheSample) {
    const RawlogResult scans = detectRawlog(kSample);
    ASSERT_THAT(scans, SizeIs(8));
    EXPECT_THAT(scans.front(), HasObstacle(Vehicle).near(10.1, -3.6, 1.0).heading(0.116, 5));
    EXPECT_EQ(scans.back().scan, 7U);
    EXPECT_NEAR(scans.back().timestamp - scans.front().timestamp, 14.0, 0.05);
}

TEST(DetectRawlog, FromAndToChooseScans) {
    RawlogOptions options;
    options.from = 2;
    options.to = 3;
    EXPECT_THAT(detectRawlog(kSample, options),
                ElementsAre(Field(&ScanObstacles::scan, 2U), Field(&ScanObstacles::scan, 3U)));
}

TEST(DetectRawlog, WhatCannotBeAnsweredIsAnErrorThatNamesTheFile) {
    RawlogOptions options;
    options.from = 8;
    EXPECT_THAT([&] { detectRawlog(kSample, options); },
                ThrowsMessage<std::runtime_error>(HasSubstr("none of its 8 scans was asked for")));
    options = {};
    options.sensor_label = "roof";
    EXPECT_THAT([&] { detectRawlog(kSample, options); }, ThrowsMessage<std::runtime_error>(HasSubstr("lidars: '")));
    EXPECT_THAT([] { detectRawlog("no.rawlog"); }, ThrowsMessage<std::runtime_error>(HasSubstr("no.rawlog")));
}

/// How far a ray from the origin goes until it meets an upright box; 1e9: never.
double hitOf(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& ray) {
    double from = 0.0, to = 1e9;
    for (int k = 0; k < 3; ++k) {
        const double a = box.min()[k] / ray[k], b = box.max()[k] / ray[k];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from < to ? from : 1e9;
}

/// Ground 1.8 m below, a car ahead on the right, of which rear and side are seen, and a wall to the left. Azimuths are
/// the sensor's: clockwise.
double carAndWall(double azimuth, double elevation) {
    const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
    const Eigen::AlignedBox3d lower(Eigen::Vector3d(8.0, -4.0, -1.6), Eigen::Vector3d(12.3, -2.2, -0.9));
    const Eigen::AlignedBox3d cabin(Eigen::Vector3d(8.8, -3.9, -0.9), Eigen::Vector3d(11.2, -2.3, -0.35));
    const double car = std::min(hitOf(lower, ray), hitOf(cabin, ray));
    const double wall = ray.y() > 0.0 ? 8.0 / ray.y() : 1e9;
    const double ground = ray.z() < -0.02 ? -1.8 / ray.z() : 1e9;
    const double nearest = std::min({car, wall, ground});
    return nearest < 100.0 ? nearest : 0.0;
}

/// Scans of a front and a rear sensor, ten times a second.
test::Objects frontAndRear(int scans) {
    test::Objects objects;
    for (int k = 0; k < scans; ++k)
        for (const bool is_front : {true, false}) {
            auto scan = std::make_shared<test::VelodyneScan>(test::makeScan({}, carAndWall));
            scan->sensorLabel = is_front ? "front" : "rear";
            scan->timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * k + (is_front ? 0.0 : 0.02));
            scan->sensorPose = mrpt::poses::CPose3D(is_front ? 1 : -1, 0, 1.8, is_front ? 0 : M_PI, 0, 0);
            objects.push_back(scan);
        }
    return objects;
}

TEST(DetectRawlog, SeveralLidarsAreJoined) {
    const test::TempFolder folder;
    test::writeRawlog(folder.file("drive.rawlog"), frontAndRear(2), true);
    RawlogOptions options;
    for (const std::string choice : {"front,rear", "all"}) {
        options.sensor_label = choice;
        const RawlogResult scans = detectRawlog(folder.file("drive.rawlog"), options);
        ASSERT_THAT(scans, SizeIs(2));
        for (const double side : {1.0, -1.0})  // each sensor has a car of its own
            EXPECT_TRUE(std::any_of(scans[0].obstacles.begin(), scans[0].obstacles.end(), [side](const Obstacle& o) {
                return std::abs(o.box.center.x() - side * 11.0) < 2.5 && std::abs(o.box.center.y() + side * 3.1) < 1.0;
            })) << side;
    }
    options.sensor_label = "front,roof";
    EXPECT_THAT([&] { detectRawlog(folder.file("drive.rawlog"), options); },
                ThrowsMessage<std::runtime_error>(HasSubstr("no lidar 'roof'; lidars: 'front', 'rear'")));
}

TEST(DetectRawlog, PosesOfTheCallerCountWhereOthersWouldBeMadeOfTheScans) {
    const test::TempFolder folder;
    test::writeRawlog(folder.file("drive.rawlog"), frontAndRear(10), true);
    RawlogOptions options;
    options.sensor_label = "front";
    options.params.ego.source = "matching";
    for (int k = -5; k < 20; ++k) {  // so what stays ahead goes as fast
        StampedPose pose;
        pose.time = 1000.0 + 0.1 * k;
        pose.position.x() = 1.0 * k;
        options.poses.push_back(pose);
    }
    const RawlogResult scans = detectRawlog(folder.file("drive.rawlog"), options);
    ASSERT_THAT(scans, SizeIs(10));
    const auto goes = [](const Obstacle& o) {
        return o.track && o.track->velocity && std::abs(o.track->velocity->x() - 10.0) < 2.0;
    };
    EXPECT_TRUE(std::any_of(scans.back().obstacles.begin(), scans.back().obstacles.end(), goes));
}

TEST(DetectRawlog, ADamagedRecordingIsAnError) {
    const test::TempFolder folder;
    const std::string bytes = test::readFile(kSample);
    const std::string damaged = folder.file("damaged.rawlog");
    test::writeFile(damaged, bytes.substr(0, bytes.size() / 2));
    EXPECT_THAT([&] { detectRawlog(damaged); }, ThrowsMessage<std::runtime_error>(HasSubstr("damaged.rawlog")));
}

}  // namespace
}  // namespace lidar_obstacles::testing
