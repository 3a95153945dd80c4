// SPDX-License-Identifier: BSD-3-Clause
// The detector on a simulated drive, and on the same drive as a rawlog: poses and tracks.
#include "lidar_obstacles/testing/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lidar_obstacles/mrpt_bridge/rawlog_writer.h"
#include "lidar_obstacles/testing/matchers.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::testing {
namespace {

using ::testing::SizeIs;

/// The vehicle drives at 5 m/s; a van 14 m ahead of it in the next lane does so at 8 m/s, a car stands.
const char* const kScenario =
    "duration: 2\n"
    "track: {width: 12, segments: [{straight: 200}]}\n"
    "sensor: {pose: {z: 1.9}}\n"
    "ego: {path: [{t: 0, s: 50}, {t: 2, s: 60}]}\n"
    "objects:\n"
    "  - {model: van, path: [{t: 0, s: 64, d: 3.5}, {t: 2, s: 80, d: 3.5}]}\n"
    "  - {model: sedan, s: 75, d: -4}\n";

TEST(DetectScenario, TracksUseThePosesOfTheSimulatedVehicle) {
    const RawlogResult scans = detectScenario(kScenario);
    ASSERT_THAT(scans, SizeIs(20));
    EXPECT_THAT(scans.back(), HasObstacle(Vehicle).near(19.8, 3.5, 1.0).heading(0, 4).speed(8, 1));
    EXPECT_THAT(scans.back(), HasObstacle(Vehicle).near(15.5, -4, 1.0).heading(0, 4).speed(0, 0.5));
    EXPECT_THAT(scans.back(), EmptyCorridor(2, 30, 1.2));
}

TEST(DetectScenario, OptionsThatLeaveNothingAreAnError) {
    ScenarioOptions options;
    options.run.from = 3;
    EXPECT_THROW(detectScenario(kScenario, options), std::invalid_argument);
    EXPECT_THROW(detectScenario("duration: soon\n"), simulation::ScenarioError);
}

/// The drive as a rawlog: a pose every 0.05 s and the scans, in the order of time.
std::string writeDrive(const test::TempFolder& folder) {
    const std::string path = folder.file("drive.rawlog");
    const simulation::World world = simulation::buildWorld(simulation::parseScenario(kScenario, "test"));
    RawlogWriter writer(path);
    double told = 0.0;
    simulation::run(world, {}, [&](const simulation::RecordedScan& scan) {
        for (const double time : simulation::ticks(told, scan.time, 0.05)) {
            writer.append(*simulation::rtkPose(world, time, 1));
        }
        told = scan.time;
        writer.append(*scan.observation);
    });
    writer.close();
    return path;
}

TEST(DetectRawlog, TracksUseThePosesOfTheRecording) {
    const test::TempFolder folder;
    EXPECT_THAT(detectRawlog(writeDrive(folder)).back(), HasObstacle(Vehicle).near(19.8, 3.5, 1.0).speed(8, 1));
}

TEST(DetectRawlog, PosesOfTheCallerTakeTheirPlace) {
    const test::TempFolder folder;
    const std::string drive = writeDrive(folder);
    const double begin = detectRawlog(drive).front().timestamp;
    RawlogOptions options;
    for (int i = -2; i < 30; ++i) {  // a vehicle that stands: what the van gains on it is its speed then
        StampedPose pose;
        pose.time = begin + 0.1 * i;
        options.poses.push_back(pose);
    }
    EXPECT_THAT(detectRawlog(drive, options).back(), HasObstacle(Vehicle).near(19.8, 3.5, 1.0).speed(3, 1));
}

}  // namespace
}  // namespace lidar_obstacles::testing
