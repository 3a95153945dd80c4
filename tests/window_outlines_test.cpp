// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay --gui: own body, region and zones are edited with the mouse and saved.
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/mrpt_bridge/zones_file.h"
#include "support/window_fixture.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::waitUntil;
using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr const char* kZones = "zones:\n  - name: stop\n    polygon: [[4, -1.2], [9, -1.2], [9, 1.2], [4, 1.2]]\n";

class WindowOutlines : public test::WindowTest {
  protected:
    void openWithZones(const std::string& zones = kZones, const std::string& more = "") {
        test::writeFile(folder_.file("zones.yaml"), zones);
        ASSERT_NO_FATAL_FAILURE(open("--zones zones.yaml --size 1000x800 --layers boxes " + more));
        press("t F2");
        ASSERT_TRUE(waitUntil([&] { return state().contains("outlines") && state()["elevation_deg"] == 90.0; }, 20s));
    }
    json corner(const std::string& outline, std::size_t k) { return state()["outlines"][outline]["at"][k]; }
    json corners(const std::string& outline) { return state()["outlines"][outline]["corners"]; }
    /// From a pixel so far, at the pace of a hand.
    void dragFrom(double x, double y, int right, int down) {
        const std::string half = std::to_string(right / 2) + " " + std::to_string(down / 2);
        EXPECT_EQ(xdotool("search --onlyvisible --name obstacle-replay mousemove --window %1 " +
                          std::to_string(static_cast<int>(std::lround(x))) + " " +
                          std::to_string(static_cast<int>(std::lround(y))) +
                          " sleep 0.2 mousedown 1 sleep 0.1 mousemove_relative --sync -- " + half +
                          " sleep 0.1 mousemove_relative --sync -- " + half + " sleep 0.1 mouseup 1 sleep 0.1"),
                  0);
    }
    void dragFrom(const json& at, int right, int down) {
        dragFrom(at[0].get<double>(), at[1].get<double>(), right, down);
    }
    void quit() {
        press("q");
        EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
    }
};

TEST_F(WindowOutlines, CornersAreDraggedAddedAndTakenAway) {
    ASSERT_NO_FATAL_FAILURE(openWithZones());
    const json before = corners("zone stop");
    const double azimuth_deg = state()["azimuth_deg"];
    dragFrom(corner("zone stop", 2), -20, -40);  // from the top: forward is up, left is left
    ASSERT_TRUE(waitUntil([&] { return corners("zone stop") != before; }, 20s));
    EXPECT_TRUE(shows("message", "zone stop changed; F3 writes the zones"));
    const json moved = corners("zone stop")[2];
    EXPECT_GT(moved[0].get<double>(), 10.0) << "farther ahead";
    EXPECT_GT(moved[1].get<double>(), 1.5) << "farther left";
    EXPECT_EQ(corners("zone stop")[0], before[0]);
    EXPECT_EQ(state()["azimuth_deg"], azimuth_deg) << "the camera stays";
    const json a = corner("zone stop", 0), b = corner("zone stop", 1);
    dragFrom((a[0].get<double>() + b[0].get<double>()) / 2, (a[1].get<double>() + b[1].get<double>()) / 2, 40, 0);
    EXPECT_TRUE(waitUntil([&] { return corners("zone stop").size() == 5; }, 20s));
    takePicture("window_outlines.png");
    press("Delete");
    EXPECT_TRUE(waitUntil([&] { return corners("zone stop").size() == 4; }, 20s));
    EXPECT_EQ(test::readFile(folder_.file("zones.yaml")), kZones) << "nothing is written without being asked";
    quit();
}

TEST_F(WindowOutlines, AFileThatIsThereIsOverwrittenOnlyAfterAYes) {
    ASSERT_NO_FATAL_FAILURE(openWithZones());
    const json before = corners("zone stop");
    dragFrom(corner("zone stop", 2), 0, -40);
    ASSERT_TRUE(waitUntil([&] { return corners("zone stop") != before; }, 20s));
    press("F3");
    EXPECT_TRUE(shows("prompt", "save the zones as: zones.yaml_"));
    press("Return");
    EXPECT_TRUE(shows("prompt", "zones.yaml is there already: overwrite it? y, enter: _"));
    press("n Return");
    EXPECT_TRUE(shows("message", "nothing is written: zones.yaml is as it was"));
    EXPECT_EQ(test::readFile(folder_.file("zones.yaml")), kZones);
    press("F3 Return Escape");
    EXPECT_TRUE(shows("prompt", ""));
    EXPECT_EQ(test::readFile(folder_.file("zones.yaml")), kZones);
    press("F3 Return y Return");
    EXPECT_TRUE(shows("message", "zones written to zones.yaml"));
    EXPECT_NEAR(loadZones(folder_.file("zones.yaml")).zones[0].polygon[2].x(), corners("zone stop")[2][0].get<double>(),
                1e-9);
    quit();
}

TEST_F(WindowOutlines, AZoneOfTheMapIsDraggedAndStaysWhereItIsWhenTheVehicleGoesOn) {
    const std::string map =  // ahead of where the street's first scan is, on its map
        "zones:\n  - name: stop\n    frame: map\n"
        "    polygon: [[98.9, -2.3], [103.9, -1.9], [103.7, 0.5], [98.7, 0.1]]\n";
    ASSERT_NO_FATAL_FAILURE(openWithZones(map));
    ASSERT_TRUE(waitUntil([&] { return state()["outlines"].contains("zone stop"); }, 20s)) << "the pose is known";
    const json before = corners("zone stop");
    dragFrom(corner("zone stop", 2), -20, -40);
    ASSERT_TRUE(waitUntil([&] { return corners("zone stop") != before; }, 20s));
    const json dragged = corners("zone stop");
    press("F3 Return y Return");
    EXPECT_TRUE(shows("message", "zones written to zones.yaml"));
    const ZoneSet saved = loadZones(folder_.file("zones.yaml"));
    ASSERT_EQ(saved.zones[0].frame, ZoneFrame::Map);
    EXPECT_EQ(saved.zones[0].polygon[0], Eigen::Vector2d(98.9, -2.3)) << "it was not moved";
    EXPECT_NEAR((saved.zones[0].polygon[2] - saved.zones[0].polygon[0]).norm(),
                std::hypot(dragged[2][0].get<double>() - dragged[0][0].get<double>(),
                           dragged[2][1].get<double>() - dragged[0][1].get<double>()),
                0.02);
    press("Right");
    EXPECT_TRUE(waitUntil([&] { return corners("zone stop")[0][0] < dragged[0][0]; }, 20s)) << "it comes nearer";
    quit();
}

TEST_F(WindowOutlines, TheBodyIsWrittenWithTheParameters) {
    ASSERT_NO_FATAL_FAILURE(openWithZones());
    const json before = corners("own body");
    dragFrom(corner("own body", 2), -30, -60);
    ASSERT_TRUE(waitUntil([&] { return corners("own body") != before; }, 20s));
    EXPECT_TRUE(shows("message", "own body changed; w writes config.ini"));
    press("w Return");
    EXPECT_TRUE(shows("message", "parameters written to config.ini"));
    EXPECT_THAT(loadParams(folder_.file("config.ini")).region.own_body, HasSubstr("box(-1, "));
    EXPECT_NE(loadParams(folder_.file("config.ini")).region.own_body, DetectorParams{}.region.own_body);
    press("w Return");
    EXPECT_TRUE(shows("prompt", "config.ini is there already: overwrite it? y, enter: _"));
    press("Escape q");
    EXPECT_EQ(replay_->wait(), 0);
}

TEST_F(WindowOutlines, TheRegionIsWrittenWithTheParametersAsItWasDragged) {
    ASSERT_NO_FATAL_FAILURE(openWithZones(kZones, "--set region.front=12 --set region.rear=6 --set region.lateral=8"));
    const json before = corners("region");
    dragFrom(corner("region", 2), -30, -40);
    ASSERT_TRUE(waitUntil([&] { return corners("region") != before; }, 20s));
    EXPECT_TRUE(shows("message", "region changed; w writes config.ini"));
    const json dragged = corners("region")[2];
    press("w Return");
    EXPECT_TRUE(shows("message", "parameters written to config.ini"));
    const RegionParams region = loadParams(folder_.file("config.ini")).region;
    EXPECT_GT(region.front, 12.5) << "farther ahead";
    EXPECT_NEAR(region.front, dragged[0].get<double>(), 1e-9);
    EXPECT_GT(region.lateral, 8.5);
    EXPECT_NEAR(region.lateral, dragged[1].get<double>(), 1e-9);
    EXPECT_EQ(region.rear, 6.0) << "it was not moved";
    quit();
}

TEST_F(WindowOutlines, WhatCannotBeRightIsRefused) {
    ASSERT_NO_FATAL_FAILURE(openWithZones());
    const json before = corners("zone stop");
    const json from = corner("zone stop", 2), to = corner("zone stop", 0);
    dragFrom(from, 0, static_cast<int>(to[1].get<double>() - from[1].get<double>()) + 60);
    EXPECT_TRUE(waitUntil([&] { return state()["message"].get<std::string>().find("zone stop: ") == 0; }, 20s))
        << state()["message"];
    EXPECT_TRUE(waitUntil([&] { return corners("zone stop") == before; }, 20s)) << "as it was";
    press("F2");
    EXPECT_TRUE(waitUntil([&] { return !state().contains("outlines"); }, 20s));
    press("Delete");
    EXPECT_TRUE(shows("message", "F2 edits outlines; then delete takes a corner away"));
    quit();
}

}  // namespace
}  // namespace lidar_obstacles
