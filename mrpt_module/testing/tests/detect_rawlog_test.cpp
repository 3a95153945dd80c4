// The detector on a rawlog in one call: scans, poses, tracks, and what is an error.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lidar_obstacles/testing/matchers.h"
#include "lidar_obstacles/testing/rawlog.h"
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

TEST(DetectRawlog, ADamagedRecordingIsAnError) {
    const test::TempFolder folder;
    const std::string bytes = test::readFile(kSample);
    const std::string damaged = folder.file("damaged.rawlog");
    test::writeFile(damaged, bytes.substr(0, bytes.size() / 2));
    EXPECT_THAT([&] { detectRawlog(damaged); }, ThrowsMessage<std::runtime_error>(HasSubstr("damaged.rawlog")));
}

}  // namespace
}  // namespace lidar_obstacles::testing
