// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay --gui: the light theme, and texts of other sizes.
#include "support/window_fixture.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::shell;
using test::waitUntil;
using testing::HasSubstr;
using namespace std::chrono_literals;

class WindowLook : public test::WindowTest {
  protected:
    /// Mean of all pixels of a screenshot in a part of the window, 0 .. 255.
    double brightness(const json& part) {
        mrpt::img::CImage picture;
        if (!picture.loadFromFile(takePicture("part.png"))) return -1.0;
        const auto x = part[0].get<unsigned>(), y = part[1].get<unsigned>();
        const auto width = part[2].get<unsigned>(), height = part[3].get<unsigned>();
        double sum = 0.0;
        for (unsigned row = y; row < y + height; ++row)
            for (unsigned k = 3 * x; k < 3 * (x + width); ++k) sum += picture.ptrLine<std::uint8_t>(row)[k];
        return sum / (3.0 * width * height);
    }
    double heightOfLabels() { return state()["labels"].empty() ? 0.0 : state()["labels"][0][1][3].get<double>(); }
    void quit() {
        press("q");
        EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
    }
};

TEST_F(WindowLook, AKeyMakesSceneAndPanelsLight) {
    ASSERT_NO_FATAL_FAILURE(open("--size 1000x700 --layers boxes,labels"));
    press("4 p");
    ASSERT_TRUE(waitUntil([&] { return state()["rows"].size() > 5; }, 20s));
    const json scene = state()["scene"], side = state()["side"], bar = state()["bar"];
    EXPECT_LT(brightness(scene), 60.0);
    EXPECT_LT(brightness(side), 90.0);
    press("F6");
    EXPECT_TRUE(shows("theme", "light"));
    EXPECT_GT(brightness(scene), 180.0);
    EXPECT_GT(brightness(side), 180.0);
    EXPECT_GT(brightness(bar), 150.0) << "the timeline";
    press("F6");
    EXPECT_TRUE(shows("theme", "dark"));
    EXPECT_LT(brightness(scene), 60.0) << "all is as it was";
    quit();
}

TEST_F(WindowLook, OptionsSayThemeAndSizeOfTexts) {
    ASSERT_NO_FATAL_FAILURE(open("--size 1000x700 --theme light --text-scale 2"));
    EXPECT_EQ(state()["theme"], "light");
    ASSERT_TRUE(waitUntil([&] { return heightOfLabels() > 0.0; }, 20s));
    EXPECT_NEAR(heightOfLabels(), 26.0, 2.0);
    press("F7");
    EXPECT_TRUE(shows("text_scale", 1.75));
    takePicture("window_light.png");
    press("F7 F7 F7");
    EXPECT_TRUE(shows("text_scale", 1.0));
    EXPECT_TRUE(waitUntil([&] { return std::abs(heightOfLabels() - 13.0) < 1.1; }, 20s)) << heightOfLabels();
    press("F8");
    EXPECT_TRUE(shows("message", "texts x1.25"));
    quit();
    EXPECT_EQ(shell("env " + display_ + " '" OBSTACLE_REPLAY "' '" STREET_SAMPLE ".rawlog' --gui --theme blue 2>'" +
                    folder_.file("out") + "'"),
              2);
    EXPECT_THAT(test::readFile(folder_.file("out")), HasSubstr("--theme"));
}

TEST_F(WindowLook, TheSceneKeepsTwoThirdsWithLargeTexts) {
    ASSERT_NO_FATAL_FAILURE(open("--size 640x480 --text-scale 3 --layers all"));
    press("4 p");
    ASSERT_TRUE(waitUntil([&] { return state()["tracks"] == true && state()["panel"] == true; }, 20s));
    for (const double scale : {3.0, 2.75, 2.5}) {
        EXPECT_TRUE(shows("text_scale", scale));
        const json now = state();
        EXPECT_GE(3 * now["scene"][2].get<double>() * now["scene"][3].get<double>(), 2.0 * 640 * 480) << scale;
        press("F7");
    }
    quit();
}

}  // namespace
}  // namespace lidar_obstacles
