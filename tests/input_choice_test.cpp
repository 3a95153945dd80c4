// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay on inputs as people really have them: what it reads, what it says of what it left out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <nlohmann/json.hpp>

#include "support/capture_files.h"
#include "support/rawlog_files.h"
#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::HasSubstr;

/// Flat ground below the sensor, nothing else.
Scene groundBelow(double height) {
    return [height](double, double elevation) { return elevation < 0.0 ? height / -std::sin(elevation) : 0.0; };
}

/// The same seen by a sensor that hangs upside down.
Scene groundAbove(double height) {
    return [height](double azimuth, double elevation) { return groundBelow(height)(azimuth, -elevation); };
}

class InputChoice : public testing::Test {
  protected:
    /// Runs obstacle-replay; `before` may be a command whose output is piped into it.
    int run(const std::string& arguments, const std::string& before = "") const {
        return shell(before + "'" OBSTACLE_REPLAY "' " + arguments + " --output '" + file("out") + "' >/dev/null 2>'" +
                     file("err") + "'");
    }
    std::string errors() const { return readFile(file("err")); }
    nlohmann::json summary() const { return nlohmann::json::parse(readFile(file("out/summary.json"))); }
    std::string file(const std::string& name) const { return folder_.file(name); }
    std::string writeCapture(const CaptureFile& capture) const {
        writeFile(file("drive.pcap"), capture.content());
        return "'" + file("drive.pcap") + "'";
    }

  private:
    TempFolder folder_;
};

TEST_F(InputChoice, ThePoseOfTheSensorCanBeSaid) {
    CaptureFile capture;
    capture.add(makeScan({}, groundAbove(1.8)), 1000.0);
    ASSERT_EQ(run(writeCapture(capture)), 0) << errors();
    EXPECT_THAT(std::string(summary()["remarks"]), HasSubstr("no ground in any scan"));
    ASSERT_EQ(run(writeCapture(capture) + " --sensor-pose 0,0,1.8,0,0,180"), 0) << errors();
    EXPECT_TRUE(summary()["remarks"].is_null());
    EXPECT_EQ(summary()["ground"]["good"], 1);
    writeRawlog(file("drive.rawlog"), {std::make_shared<VelodyneScan>(makeScan({}, groundAbove(1.8)))}, true);
    ASSERT_EQ(run("'" + file("drive.rawlog") + "' --sensor-pose 0,0,1.8,0,0,180"), 0) << errors();
    EXPECT_EQ(summary()["ground"]["good"], 1) << "whatever the recording says";
    EXPECT_EQ(run(writeCapture(capture) + " --sensor-pose 0,0,1.8"), 2);
    EXPECT_THAT(errors(), HasSubstr("--sensor-pose 0,0,1.8: must be X,Y,Z,YAW,PITCH,ROLL"));
}

TEST_F(InputChoice, PortAndSenderOfACaptureCanBeChosen) {
    CaptureFile capture;
    capture.add(makeScan({}, groundBelow(1.8)), 1000.0);
    capture.add(makeScan({}, groundBelow(1.8)), 1000.0, 0xc0a801caU, 2369);
    const std::string input = writeCapture(capture);
    EXPECT_EQ(run(input), 2);
    EXPECT_THAT(errors(), HasSubstr("several lidars, choose one with --sensor-label: 'velodyne' (1 scans), "
                                    "'velodyne_192.168.1.202' (1 scans)"));
    EXPECT_EQ(run(input + " --port 2369"), 0) << errors();
    EXPECT_EQ(run(input + " --source 192.168.1.202"), 0) << errors();
    EXPECT_THAT(std::string(summary()["remarks"]), HasSubstr("(192.168.1.201: 75)"));
    EXPECT_EQ(run(input + " --source 192.168.1"), 2);
    EXPECT_EQ(run(input + " --port 8308"), 1);
    EXPECT_THAT(errors(), HasSubstr("no lidar scans in it: packets to other ports left out (2368: 75, 2369: 75)"));
}

TEST_F(InputChoice, WhatWasLeftOutIsSaidEvenWhereNothingRemains) {
    CaptureFile capture(CaptureFile::kEthernet, 96);
    capture.add(makeScan({}, groundBelow(1.8)), 1000.0);
    EXPECT_EQ(run(writeCapture(capture)), 1);
    EXPECT_THAT(errors(), HasSubstr("no lidar scans in it: 75 packets cut short by the capture"));
    EXPECT_EQ(shell("'" OCTOMAP_BUILD "' '" + file("drive.pcap") + "' '" + file("map.bt") + "' 2>/dev/null"), 2);
}

TEST_F(InputChoice, AClockThatJumpsIsSaid) {
    VelodyneScan scan = makeScan({}, groundBelow(1.8));
    for (std::size_t k = 40; k < 75; ++k)
        setClock(scan.scan_packets[k], scan.scan_packets[k].gps_timestamp() + 1'500'000'000U);
    writeRawlog(file("drive.rawlog"), {std::make_shared<VelodyneScan>(scan)}, true);
    ASSERT_EQ(run("'" + file("drive.rawlog") + "'"), 0) << errors();
    EXPECT_THAT(std::string(summary()["remarks"]), HasSubstr("the times of 35 packets follow from their azimuths"));
}

TEST_F(InputChoice, ScansThatAreNotInTheirOrderAreSaid) {
    writeRawlog(file("drive.rawlog"),
                {scanLabelled("top", 10.0), scanLabelled("top", 10.2), scanLabelled("top", 10.1),
                 scanLabelled("top", 10.3), scanLabelled("top", 10.3)},
                true);
    ASSERT_EQ(run("'" + file("drive.rawlog") + "'"), 0) << errors();
    EXPECT_EQ(summary()["scans"], 5);
    EXPECT_THAT(std::string(summary()["remarks"]), HasSubstr("2 scans are not stamped after the one before"));
    writeRawlog(file("drive.rawlog"), {scanLabelled("top", 10.0), scanLabelled("top", 10.1)}, true);
    ASSERT_EQ(run("'" + file("drive.rawlog") + "'"), 0) << errors();
    EXPECT_TRUE(summary()["remarks"].is_null() ||
                std::string(summary()["remarks"]).find("stamped") == std::string::npos);
}

TEST_F(InputChoice, ScansWithoutReturnsAndTiltedSensorsAreSaid) {
    const auto far = [](double, double) { return 100.0; };
    auto tilted = std::make_shared<VelodyneScan>(makeScan({}, groundBelow(1.8)));
    tilted->sensorPose = mrpt::poses::CPose3D(0, 0, 1.8, 0, 0, M_PI / 2);
    tilted->timestamp = mrpt::Clock::fromDouble(1'000'001.0);
    writeRawlog(file("drive.rawlog"), {std::make_shared<VelodyneScan>(makeScan({}, far)), tilted}, true);
    ASSERT_EQ(run("'" + file("drive.rawlog") + "' --sensor-label '' --set sensor.max_range=50"), 0) << errors();
    EXPECT_THAT(std::string(summary()["remarks"]), HasSubstr("1 scans hold no return between [sensor] min_range"));
    ASSERT_EQ(run("'" + file("drive.rawlog") + "' --sensor-label '#2'"), 0) << errors();
    EXPECT_THAT(std::string(summary()["remarks"]), HasSubstr("a sensor is tilted by more than 20 degrees"));
}

TEST_F(InputChoice, APipeIsReadLikeAFile) {
    CaptureFile capture;
    capture.add(makeScan({}, groundBelow(1.8)), 1000.0);
    const std::string input = writeCapture(capture);
    writeRawlog(file("drive.rawlog"), {std::make_shared<VelodyneScan>(makeScan({}, groundBelow(1.8)))}, true);
    ASSERT_EQ(run("/dev/stdin", "cat " + input + " | "), 0) << errors();
    EXPECT_EQ(summary()["scans"], 1);
    ASSERT_EQ(run("-", "cat '" + file("drive.rawlog") + "' | "), 0) << errors();
    EXPECT_EQ(summary()["scans"], 1);
    EXPECT_EQ(run("-", "true | "), 1) << "an empty one";
}

/// Scans of two sensors 2 m apart, 20 ms after each other.
Objects frontAndRear() {
    Objects objects;
    for (int k = 0; k < 3; ++k)
        for (const bool is_front : {true, false}) {
            auto scan = std::make_shared<VelodyneScan>(makeScan({}, groundBelow(1.8)));
            scan->sensorLabel = is_front ? "front" : "rear";
            scan->timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * k + (is_front ? 0.0 : 0.02));
            scan->sensorPose = mrpt::poses::CPose3D(is_front ? 1 : -1, 0, 1.8, is_front ? 0 : M_PI, 0, 0);
            objects.push_back(scan);
        }
    return objects;
}

TEST_F(InputChoice, SeveralLidarsAreJoined) {
    writeRawlog(file("drive.rawlog"), frontAndRear(), true);
    const std::string input = "'" + file("drive.rawlog") + "' --sensor-label ";
    ASSERT_EQ(run(input + "front"), 0) << errors();
    const auto alone = summary();
    for (const std::string choice : {"front,rear", "all"}) {
        ASSERT_EQ(run(input + choice), 0) << errors();
        EXPECT_EQ(summary()["scans"], 3);
        EXPECT_EQ(summary()["returns"], 2 * alone["returns"].get<int>());
        EXPECT_EQ(summary()["ground"]["good"], 3);
        EXPECT_EQ(summary()["sensor_label"], choice);
    }
    EXPECT_EQ(run(input + "front,roof"), 2);
    EXPECT_THAT(errors(), HasSubstr("no lidar 'roof'; there are: 'front' (3 scans), 'rear' (3 scans)"));
    EXPECT_EQ(run(input + "all --sensor-pose 0,0,1,0,0,0"), 2);
    EXPECT_THAT(errors(), HasSubstr("several lidars are not at one place"));
    EXPECT_EQ(run(input + "all --gui"), 2);
    ASSERT_EQ(run(input + "all --sensor-pose rear=-1,0,-1.8,180,0,0 --sensor-pose front=1,0,1.8,0,0,0"), 0) << errors();
}

TEST_F(InputChoice, NamesOfLidarsMayHaveSpacesBesideThem) {
    writeRawlog(file("drive.rawlog"), frontAndRear(), true);
    const std::string input = "'" + file("drive.rawlog") + "' --sensor-label ";
    ASSERT_EQ(run(input + "'front, rear'"), 0) << errors();
    EXPECT_EQ(summary()["scans"], 3);
    ASSERT_EQ(run(input + "'front, rear' --sensor-pose 'rear = -1, 0, 1.8, 180, 0, 0'"), 0) << errors();
    EXPECT_EQ(run(input + "front,"), 2);
    EXPECT_THAT(errors(), HasSubstr("no lidar ''; there are: 'front' (3 scans), 'rear' (3 scans)"));
}

TEST_F(InputChoice, APoseOfALidarThatIsNotThereIsAnError) {
    writeRawlog(file("drive.rawlog"), frontAndRear(), true);
    const std::string input = "'" + file("drive.rawlog") + "' --sensor-label ";
    const std::string there =
        "no lidar 'roof', which --sensor-pose names; there are: 'front' (3 scans), 'rear' (3 scans)";
    EXPECT_EQ(run(input + "front --sensor-pose roof=0,0,1.8,0,0,0"), 2);
    EXPECT_THAT(errors(), HasSubstr(there));
    EXPECT_EQ(run(input + "all --sensor-pose roof=0,0,1.8,0,0,0"), 2);
    EXPECT_THAT(errors(), HasSubstr(there));
    EXPECT_EQ(run(input + "front --sensor-pose 0,0,1,0,0,0 --sensor-pose 0,0,2,0,0,0"), 2);
    EXPECT_THAT(errors(), HasSubstr("there is a pose of that sensor already"));
}

TEST_F(InputChoice, APoseBeyondAllVehiclesIsAnError) {
    writeRawlog(file("drive.rawlog"), frontAndRear(), true);
    const std::string input = "'" + file("drive.rawlog") + "' --sensor-label front --sensor-pose ";
    EXPECT_EQ(run(input + "1e300,0,0,0,0,0"), 2);
    EXPECT_THAT(errors(), HasSubstr("--sensor-pose 1e300,0,0,0,0,0: X, Y and Z must be within 100 m"));
    EXPECT_EQ(run(input + "0,0,-101,0,0,0"), 2);
    EXPECT_EQ(run(input + "0,0,0,361,0,0"), 2);
    EXPECT_THAT(errors(), HasSubstr("YAW, PITCH and ROLL must be within 360 degrees"));
    EXPECT_EQ(run(input + "0,0,1.8,nan,0,0"), 2);
}

TEST_F(InputChoice, PointsThatAreInTheVehiclesFrameStayWhereTheyAre) {
    VelodyneScan turn = makeScan({}, groundBelow(1.8));
    turn.generatePointCloud();
    const auto cloud = std::make_shared<mrpt::obs::CObservationPointCloud>();
    auto points = mrpt::maps::CSimplePointsMap::Create();
    for (std::size_t i = 0; i < turn.point_cloud.size(); ++i)
        points->insertPoint(turn.point_cloud.x[i], turn.point_cloud.y[i], turn.point_cloud.z[i] + 1.8f);
    cloud->pointcloud = points;
    writeRawlog(file("drive.rawlog"), {cloud}, true);
    const std::string input = "'" + file("drive.rawlog") + "'";
    ASSERT_EQ(run(input), 0) << errors();
    EXPECT_THAT(std::string(summary()["remarks"]), HasSubstr("say so with --points-in-vehicle"));
    ASSERT_EQ(run(input + " --points-in-vehicle --sensor-pose 0,0,1.8,0,0,0"), 0) << errors();
    EXPECT_TRUE(summary()["remarks"].is_null()) << summary()["remarks"];
    EXPECT_EQ(summary()["ground"]["good"], 1);
    EXPECT_EQ(run(input + " --points-in-vehicle"), 2);
    EXPECT_THAT(errors(), HasSubstr("--points-in-vehicle needs --sensor-pose"));
}

TEST_F(InputChoice, LidarsOfOneLabelAreChosenByTheirNumber) {
    const auto front = std::make_shared<VelodyneScan>(makeScan({}, groundBelow(1.8)));
    const auto rear = std::make_shared<VelodyneScan>(*front);
    rear->sensorPose = mrpt::poses::CPose3D(-2, 0, 0, M_PI, 0, 0);
    writeRawlog(file("drive.rawlog"), {front, rear, front}, true);
    EXPECT_EQ(run("'" + file("drive.rawlog") + "'"), 2);
    EXPECT_THAT(errors(), HasSubstr("'' (2 scans), '#2' (1 scans)"));
    ASSERT_EQ(run("'" + file("drive.rawlog") + "' --sensor-label '#2'"), 0) << errors();
    EXPECT_EQ(summary()["scans"], 1);
}

}  // namespace
}  // namespace lidar_obstacles
