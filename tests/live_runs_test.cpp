// SPDX-License-Identifier: BSD-3-Clause
// obstacle-live: captures, maps, outputs that break, mistakes on the command line.
#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "lidar_obstacles/live/packet_source.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/static_map.h"
#include "support/capture_files.h"
#include "support/live_program.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::Not;

TEST_F(Live, ACaptureAtFullSpeedIsTakenWhole) {
    Turn turn;
    turn.packets = 750;  // ten turns
    CaptureFile capture;
    capture.add(makeScan(turn, wallAt(10.0)), 1000.0);
    writeFile(file("capture.pcap"), capture.content());
    auto live = start({file("capture.pcap"), "--speed", "max", "--cut-azimuth", "0"});
    EXPECT_EQ(live->wait(), 0) << err();
    EXPECT_EQ(lines(out()).size(), 10u);
    EXPECT_EQ(statistics()["packets"], 750);
    EXPECT_EQ(statistics()["lost"], 0);
    EXPECT_EQ(statistics()["scans_dropped"], 0);
}

TEST_F(Live, WithoutPosesItSaysOnceWhatItDoesWithout) {
    auto live = startListening({"--set", "octomap.mode=spurious", "--set", "grid.scans=2"});
    send({"--duration", "1"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    EXPECT_GT(lines(out()).size(), 5u);
    const std::string text = err();
    const auto first = text.find("no poses are known: scans are not de-skewed, a grid holds one scan, the 3D filter");
    ASSERT_NE(first, std::string::npos) << text;
    EXPECT_EQ(text.find("no poses", first + 10), std::string::npos) << "told once";
}

/// Flat ground 1.8 m below the sensor and the rear of a van 10 m ahead.
double vanAhead(double azimuth, double elevation) {
    const double forward = std::cos(azimuth) * std::cos(elevation);
    const double rear = forward > 0.0 ? 10.0 / forward : 1e9;
    const double across = rear * std::sin(azimuth) * std::cos(elevation);
    const double up = rear * std::sin(elevation);
    if (std::abs(across) < 0.95 && up > -1.8 && up < 0.3) return rear;
    return elevation < -0.02 ? -1.8 / std::sin(elevation) : 0.0;
}

/// The same, and the side of a car 8 m to the right.
double vanAheadCarToTheRight(double azimuth, double elevation) {
    const double right = std::sin(azimuth) * std::cos(elevation);
    const double side = right > 0.0 ? 8.0 / right : 1e9;
    const double along = side * std::cos(azimuth) * std::cos(elevation);
    const double up = side * std::sin(elevation);
    if (std::abs(along) < 2.0 && up > -1.8 && up < -0.3) return side;
    return vanAhead(azimuth, elevation);
}

TEST_F(Live, AVehicleThatStandsInAMapSeesOnlyWhatIsNotInIt) {
    Turn turns;
    turns.packets = 225;  // three of them
    const VelodyneScan scan = makeScan(turns, vanAhead);
    CaptureFile capture;
    capture.add(makeScan(turns, vanAheadCarToTheRight), 1000.0);
    writeFile(file("capture.pcap"), capture.content());
    StaticMapBuilder map(0.2, 40.0);
    map.insert(toPointCloud(scan, SensorParams{}), Eigen::Isometry3d::Identity());
    map.save(file("map.bt"));
    const std::vector<std::string> common{
        file("capture.pcap"),           "--speed", "max", "--set", "octomap.mode=static", "--set",
        "octomap.map=" + file("map.bt")};
    EXPECT_EQ(start(common)->wait(), 0) << err();
    EXPECT_GE(statistics()["obstacles"], 5) << "where it stands is not known: van and car";
    EXPECT_THAT(err(), HasSubstr("no poses are known: the map of what stands still is not used"));
    std::vector<std::string> standing = common;
    standing.insert(standing.end(), {"--standing-at", "0,0,0,0,0,0"});
    EXPECT_EQ(start(standing)->wait(), 0) << err();
    int seen = 0;
    for (const Json& line : lines(out()))
        for (const Json& o : line["obstacles"]) {
            EXPECT_NEAR(o["x"].get<double>(), 0.0, 1.0) << "the van";
            EXPECT_LT(o["y"].get<double>(), -7.5);
            ++seen;
        }
    EXPECT_GE(seen, 2) << "once in each whole turn";
    EXPECT_THAT(err(), Not(HasSubstr("no poses")));
    EXPECT_GE(statistics()["detected"], 3);
}

/// Sends one datagram to "ADDRESS:PORT".
void sendDatagram(const std::string& endpoint, const std::string& text) {
    const live::Endpoint to = live::parseEndpoint(endpoint, {});
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(to.port);
    address.sin_addr.s_addr = htonl(to.address);
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    ASSERT_EQ(::sendto(socket, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&address), sizeof address),
              static_cast<ssize_t>(text.size()));
    ::close(socket);
}

TEST_F(Live, PosesComeToASocketAndBadLinesAreToldOnce) {
    auto live = startListening({"--poses", "127.0.0.1:0", "--to", "none"});
    const std::string poses = waitFor("poses on ");
    std::atomic<bool> done{false};
    std::thread robot([&] {
        while (!done) {  // stands; a line of its position now and one of soon
            const double now = live::wallClock();
            const auto line = [](double time) {
                return Json({{"timestamp", time}, {"x", 1.0}, {"y", 2.0}, {"yaw", 0.1}}).dump() + "\n";
            };
            sendDatagram(poses, line(now) + line(now + 0.2));
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    });
    sendDatagram(poses, "no pose at all\n{\"timestamp\": 1, \"x\": 0, \"yaw\": 0}\n");
    send({"--duration", "1"});
    done = true;
    robot.join();
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    EXPECT_GT(statistics()["poses"], 20);
    EXPECT_EQ(statistics()["poses_refused"], 2);
    EXPECT_THAT(err(), HasSubstr("no pose: a pose is a line of JSON"));
    EXPECT_THAT(err(), Not(HasSubstr("no poses are known")));
}

TEST_F(Live, WithMatchingEachScanIsMatchedOrSaysThatItIsNot) {
    auto live = startListening({"--set", "ego.source=matching", "--to", "none"});
    send({"--duration", "1"});
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    const Json s = statistics();
    EXPECT_EQ(s["scans_matched"].get<int>() + s["scans_not_matched"].get<int>(), s["detected"].get<int>());
    EXPECT_GT(s["detected"], 0) << "how many of the ten depends on the machine";
    EXPECT_THAT(err(), Not(HasSubstr("no poses are known")));
}

TEST_F(Live, AReaderThatWentAwayIsAnErrorAndTheRecordingIsComplete) {
    ASSERT_EQ(mkfifo(file("out").c_str(), 0600), 0);
    std::thread reader([&] {
        char byte = 0;
        const int pipe = open(file("out").c_str(), O_RDONLY);
        EXPECT_EQ(read(pipe, &byte, 1), 1);
        close(pipe);
    });
    auto live = startListening({"--record", file("drive.rawlog")});
    send({"--duration", "2"});
    reader.join();
    EXPECT_EQ(live->wait(), 1) << "by itself";
    EXPECT_THAT(err(), HasSubstr("cannot write to the standard output"));
    const auto source = openScanSource(file("drive.rawlog"));
    EXPECT_TRUE(source->next());
}

TEST_F(Live, AFullDiskEndsTheRecordingAndIsTold) {
    limit_ = 60'000;  // bytes of a file: two or three scans
    auto live = startListening({"--record", file("drive.rawlog"), "--to", "none"});
    send({"--duration", "2"});
    EXPECT_THAT(err(), HasSubstr(file("drive.rawlog") + ": cannot write: File too large; the recording ends here"));
    live->interrupt();
    EXPECT_EQ(live->wait(), 1);
    EXPECT_GE(statistics()["detected"].get<int>() + statistics()["scans_dropped"].get<int>(), 20) << "the run goes on";
    EXPECT_GE(statistics()["recorded"], 1);
    const auto source = openScanSource(file("drive.rawlog"));
    std::size_t scans = 0;
    while (source->next()) ++scans;
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
    EXPECT_EQ(scans, statistics()["recorded"]);
}

TEST_F(Live, WhatIsWrongWithTheCommandLineIsSaid) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"--listen", "localhost"}, "not an IPv4 address"},
        {{"--source", "1.2.3"}, "--source 1.2.3: not an IPv4 address"},
        {{"--sensor-pose", "1,2,3"}, "X,Y,Z,YAW,PITCH,ROLL"},
        {{"--sensor-pose", "1e300,0,0,0,0,0"}, "--sensor-pose 1e300,0,0,0,0,0: X, Y and Z must be within 100 m"},
        {{"--beside", "1.2.3:1=0,0,0,0,0,0"}, "--beside 1.2.3: not an IPv4 address"},
        {{"--beside", ":70000=0,0,0,0,0,0"}, "--beside :70000: the port must be"},
        {{"--beside", ":2369=0,0,0,0,0,500"}, "--beside 0,0,0,0,0,500: YAW, PITCH and ROLL must be within 360 degrees"},
        {{"--serve", "127.0.0.1"}, ":PORT"},
        {{"--standing-at", "1,2"}, "--standing-at 1,2"},
        {{"--poses", "5001"}, "--poses 5001: must be [ADDRESS]:PORT"},
        {{"--poses", ":5001", "--standing-at", "0,0,0,0,0,0"}, "either --poses or --standing-at"},
        {{"--set", "ego.source=matching", "--standing-at", "0,0,0,0,0,0"}, "matching"},
        {{"a.pcap", "--listen", "127.0.0.1"}, "either"},
        {{"--set", "grid.resolution=x"}, "grid"},
        {{"--config", "/nonexistent.ini"}, "/nonexistent.ini"},
        {{"--speed", "fast"}, "--speed"},
    };
    for (const auto& [arguments, message] : cases) {
        EXPECT_EQ(start(arguments)->wait(), 2) << arguments[0];
        EXPECT_THAT(err(), HasSubstr(message));
    }
    EXPECT_EQ(start({"--listen", "127.0.0.1:0", "--beside", "192.0.2.1:2369=0,0,1,0,0,0"})->wait(), 1);
    EXPECT_THAT(err(), HasSubstr("--beside: UDP 192.0.2.1:2369: cannot listen")) << "no address of this machine";
    EXPECT_EQ(start({"/nonexistent.pcap"})->wait(), 1);
    EXPECT_THAT(err(), HasSubstr("/nonexistent.pcap"));
    EXPECT_EQ(start({"--set", "octomap.mode=static", "--set", "octomap.map=/nonexistent.bt"})->wait(), 1);
    EXPECT_THAT(err(), HasSubstr("/nonexistent.bt: cannot open the map"));
    EXPECT_EQ(start({"--record", "/nonexistent/drive.rawlog", "--listen", "127.0.0.1:0"})->wait(), 1);
    EXPECT_THAT(err(), HasSubstr("/nonexistent/drive.rawlog"));
}

}  // namespace
}  // namespace lidar_obstacles
