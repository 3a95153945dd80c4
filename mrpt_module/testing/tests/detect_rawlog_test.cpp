// The detector on a rawlog in one call: scans, poses, tracks, and what is an error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

/// Ground 1.8 m below, the rear of a van 10 m ahead and a wall to the left.
double vanAndWall(double azimuth, double elevation) {
    const double forward = std::cos(azimuth) * std::cos(elevation), left = -std::sin(azimuth) * std::cos(elevation);
    const double rear = forward > 0.0 ? 10.0 / forward : 1e9, wall = left > 0.0 ? 8.0 / left : 1e9;
    if (rear < wall && std::abs(rear * left) < 0.95 && std::abs(rear * std::sin(elevation) + 0.7) < 1.1) return rear;
    const double ground = elevation < -0.02 ? -1.8 / std::sin(elevation) : 1e9;
    const double nearest = std::min(wall, ground);
    return nearest < 100.0 ? nearest : 0.0;
}

/// Scans of a front and a rear sensor, ten times a second.
test::Objects frontAndRear(int scans) {
    test::Objects objects;
    for (int k = 0; k < scans; ++k)
        for (const bool is_front : {true, false}) {
            auto scan = std::make_shared<test::VelodyneScan>(test::makeScan({}, vanAndWall));
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
        for (const double x : {11.0, -11.0})
            EXPECT_TRUE(std::any_of(scans[0].obstacles.begin(), scans[0].obstacles.end(), [x](const Obstacle& o) {
                return std::abs(o.box.center.x() - x) < 3.0 && std::abs(o.box.center.y()) < 1.0;
            })) << x;
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
