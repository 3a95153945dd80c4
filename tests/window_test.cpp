// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay --gui: keys, camera, parameters, files.
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "support/window_fixture.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::shell;
using test::waitUntil;
using testing::HasSubstr;
using namespace std::chrono_literals;

class Window : public test::WindowTest {};

TEST_F(Window, FollowsTheKeys) {
    ASSERT_NO_FATAL_FAILURE(open("--truth '" STREET_SAMPLE "_gt.csv'"));
    EXPECT_TRUE(shows("scan", 0));
    const json first = state()["boxes"];
    EXPECT_GT(first.size(), 5U);
    press("Right");
    EXPECT_TRUE(shows("scan", 1));
    press("End");
    EXPECT_TRUE(shows("scan", 7));
    press("Home");
    EXPECT_TRUE(shows("scan", 0));
    EXPECT_EQ(state()["boxes"], first);
    press("j 3 Return");
    EXPECT_TRUE(shows("scan", 3));
    press("j 1 0 s Return");
    EXPECT_TRUE(shows("scan", 5)) << "10 s after the first one";
    press("Up Up Up Up Up l space");
    EXPECT_TRUE(shows("playing", true));
    EXPECT_TRUE(shows("scan", 0)) << "after the last one, in a loop";
    press("space");
    EXPECT_TRUE(shows("playing", false));
    press("h");
    EXPECT_TRUE(shows("help", true));
    press("4");
    EXPECT_TRUE(shows("tracks", true));
    press("q");
    EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
}

TEST_F(Window, TurnsLayersAndCamera) {
    ASSERT_NO_FATAL_FAILURE(open("--truth '" STREET_SAMPLE "_gt.csv' --layers boxes"));
    EXPECT_EQ(state()["layers"].size(), 1U);
    turnEachLayer();
    press("c");
    EXPECT_TRUE(shows("color", "intensity"));
    press("t");
    EXPECT_TRUE(shows("camera", "top"));
    press("f");
    EXPECT_TRUE(shows("camera", "follow"));
    drag();
    EXPECT_TRUE(shows("camera", "free"));
    press("alt+F4");  // openbox closes the window
    EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
}

TEST_F(Window, AKeyTakesTheCameraBackFromTheMouse) {
    ASSERT_NO_FATAL_FAILURE(open());
    struct Camera {
        std::string key, name;
        double elevation_deg;
    };
    for (const Camera& camera : {Camera{"f", "follow", 32.0}, {"t", "top", 90.0}, {"f", "follow", 32.0}}) {
        drag();
        EXPECT_TRUE(shows("camera", "free"));
        EXPECT_NE(state()["azimuth_deg"], 180.0);
        press(camera.key);
        EXPECT_TRUE(shows("camera", camera.name));
        EXPECT_TRUE(shows("azimuth_deg", 180.0));
        EXPECT_TRUE(shows("elevation_deg", camera.elevation_deg));
    }
    press("Right");
    EXPECT_TRUE(shows("scan", 1));
    EXPECT_EQ(state()["camera"], "follow");
    const double distance = state()["distance"];
    mouse("click 4");
    EXPECT_TRUE(waitUntil([&] { return state()["distance"] < distance; }, 20s)) << "the wheel brings it nearer";
    EXPECT_EQ(state()["camera"], "follow") << "a turn of the wheel is no other camera";
    press("t Left");
    EXPECT_TRUE(shows("scan", 0));
    EXPECT_TRUE(shows("elevation_deg", 90.0));
    press("q");
    EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
}

TEST_F(Window, EveryKeyWorksAfterTheMouse) {
    ASSERT_NO_FATAL_FAILURE(open("--truth '" STREET_SAMPLE "_gt.csv' --layers boxes"));
    drag();
    EXPECT_TRUE(shows("camera", "free"));
    mouse("click 5");
    EXPECT_TRUE(waitUntil([&] { return state()["distance"] > 38.0; }, 20s)) << "the wheel takes it away";
    const double azimuth_deg = state()["azimuth_deg"];
    turnEachLayer();
    press("c");
    EXPECT_TRUE(shows("color", "intensity"));
    press("End");
    EXPECT_TRUE(shows("scan", 7));
    press("j 3 Return");
    EXPECT_TRUE(shows("scan", 3));
    press("Up l space");
    EXPECT_TRUE(shows("playing", true));
    press("space");
    EXPECT_TRUE(shows("playing", false));
    press("h");
    EXPECT_TRUE(shows("help", true));
    press("h p");
    EXPECT_TRUE(shows("panel", true));
    EXPECT_EQ(state()["camera"], "free") << "only the keys of the camera move it";
    EXPECT_EQ(state()["azimuth_deg"], azimuth_deg);
    const double distance = state()["distance"];
    press("i");
    EXPECT_TRUE(waitUntil([&] { return state()["distance"] < 0.9 * distance; }, 20s));
    press("o");
    EXPECT_TRUE(waitUntil([&] { return std::abs(state()["distance"].get<double>() - distance) < 1e-3; }, 20s));
    press("q");
    EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
}

TEST_F(Window, ShowsWhatTheDetectorWithMemoryFinds) {
    ASSERT_NO_FATAL_FAILURE(
        open("--layers voxels,filtered,boxes --set octomap.mode=spurious --set octomap.min_hits=2 "
             "--set deskew.enabled=true --set grid.scans=2"));
    press("End");
    EXPECT_TRUE(shows("scan", 7));
    const json last = state();
    EXPECT_GT(last["layers"]["filtered"].get<int>(), 0);
    EXPECT_GT(last["layers"]["voxels"].get<int>(), 0);
    EXPECT_THAT(last["used"].get<std::string>(), HasSubstr("pose: at; de-skewed; 3D filter: "));
    EXPECT_THAT(last["used"].get<std::string>(), HasSubstr("; grid of 2 scans"));
    press("Home Right Right Left Right Right Right Right Right Right");
    EXPECT_TRUE(shows("scan", 7));
    EXPECT_EQ(state()["boxes"], last["boxes"]);
    EXPECT_EQ(state()["layers"], last["layers"]);
    press("q");
    EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
}

TEST_F(Window, AMapThatCannotBeReadIsAnErrorAtOnce) {
    test::writeFile(folder_.file("bad.bt"), "no map");
    const std::string command = "env " + display_ +
                                " '" OBSTACLE_REPLAY "' '" STREET_SAMPLE
                                ".rawlog' --gui --set octomap.mode=static --set octomap.map=";
    EXPECT_EQ(shell(command + folder_.file("bad.bt") + " 2>'" + folder_.file("out") + "'"), 1);
    EXPECT_THAT(test::readFile(folder_.file("out")), HasSubstr("bad.bt: no OctoMap tree"));
    EXPECT_EQ(shell(command + "none 2>'" + folder_.file("out") + "'"), 2);
    EXPECT_THAT(test::readFile(folder_.file("out")), HasSubstr("[octomap] mode = static needs a map"));
}

TEST_F(Window, ChangesAndSavesParametersAndTakesPictures) {
    ASSERT_NO_FATAL_FAILURE(open());
    const int before = state()["returns"];
    press("p Down Down Down Down Return 8 Return");  // [sensor] planes
    EXPECT_TRUE(waitUntil([&] { return state()["returns"].get<int>() < 0.6 * before; })) << "decimated at once";
    press("w Return");
    EXPECT_TRUE(shows("message", "parameters written to config.ini"));
    EXPECT_EQ(loadParams(folder_.file("config.ini")).sensor.planes, 8);
    press("s");
    EXPECT_TRUE(shows("message", "screenshot: screenshot_000000_0.png"));
    mrpt::img::CImage picture;
    ASSERT_TRUE(picture.loadFromFile(folder_.file("screenshot_000000_0.png")));
    std::size_t bright = 0;
    for (unsigned y = 0; y < picture.getHeight(); ++y)
        for (unsigned x = 0; x < 3 * picture.getWidth(); ++x)
            bright += picture.ptrLine<std::uint8_t>(y)[x] > 128 ? 1 : 0;
    EXPECT_GT(bright, 1000U) << "the picture is black";
    press("q");
    EXPECT_EQ(replay_->wait(), 0);
}

}  // namespace
}  // namespace lidar_obstacles
