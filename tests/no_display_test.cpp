// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay where there is no display: --gui says so, --record needs none.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include <chrono>
#include <filesystem>

#include "support/shell.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace test {

inline std::string ffmpeg() { return shell("command -v ffmpeg >/dev/null 2>&1") == 0 ? "there" : ""; }

}  // namespace test

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using test::shell;
using testing::HasSubstr;

class NoDisplay : public testing::Test {
  protected:
    int run(const std::string& arguments, const std::string& display = "-u DISPLAY") {
        return shell("env " + display + " '" OBSTACLE_REPLAY "' '" STREET_SAMPLE ".rawlog' --output '" +
                     folder_.file("o") + "' " + arguments + " >'" + folder_.file("out") + "' 2>'" +
                     folder_.file("err") + "'");
    }
    std::string error() { return test::readFile(folder_.file("err")); }
    test::TempFolder folder_;
};

TEST_F(NoDisplay, TheWindowSaysSoAtOnceAndNamesTheWayOut) {
    for (const char* display : {"DISPLAY=", "DISPLAY=:98765", "-u DISPLAY"}) {
        const auto start = std::chrono::steady_clock::now();
        EXPECT_EQ(run("--gui", display), 2) << display;
        EXPECT_LT(std::chrono::steady_clock::now() - start, 4s) << display << ": MRPT itself waits 5 s";
        EXPECT_THAT(error(), HasSubstr("--record")) << display;
    }
}

TEST_F(NoDisplay, ARunIsDrawnIntoAFolder) {
    ASSERT_EQ(run("--from 2 --to 4 --every 2 --layers all --size 320x240 --record '" + folder_.file("frames") + "'"), 0)
        << error();
    mrpt::img::CImage picture;
    for (const char* name : {"frames/frame_000002.png", "frames/frame_000004.png"}) {
        ASSERT_TRUE(picture.loadFromFile(folder_.file(name))) << name;
        EXPECT_EQ(picture.getWidth(), 320U);
    }
    EXPECT_FALSE(fs::exists(folder_.file("frames/frame_000003.png")));
    EXPECT_TRUE(fs::exists(folder_.file("o/obstacles.csv"))) << "the results are written as always";
}

TEST_F(NoDisplay, ARunBecomesAVideo) {
    LIDAR_OBSTACLES_NEED(encoder, ffmpeg());
    const std::string video = folder_.file("run.mp4");
    ASSERT_EQ(run("--to 3 --record '" + video + "'"), 0) << error();
    EXPECT_FALSE(fs::exists(video + ".part"));
    ASSERT_EQ(shell("ffmpeg -loglevel error -i '" + video + "' '" + folder_.file("f%d.png") + "'"), 0);
    EXPECT_TRUE(fs::exists(folder_.file("f4.png")));
    EXPECT_FALSE(fs::exists(folder_.file("f5.png")));
}

TEST_F(NoDisplay, MistakesInTheOptionsAreTold) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"--layers boxes,sky", "'sky' is none of raw, ground"},
        {"--color loud", "must be height, intensity or ring"},
        {"--size 801x600", "even numbers"},
        {"--size big", "WIDTHxHEIGHT"},
        {"--record run.avi", ".mp4"},
        {"--gui --record x.mp4", "one of the two"},
    };
    for (const auto& [arguments, message] : cases) {
        EXPECT_EQ(run(arguments), 2) << arguments;
        EXPECT_THAT(error(), HasSubstr(message)) << arguments;
    }
    EXPECT_EQ(run("--record x.mp4 --truth /nonexistent.csv"), 1);
    EXPECT_THAT(error(), HasSubstr("/nonexistent.csv"));
}

}  // namespace
}  // namespace lidar_obstacles
