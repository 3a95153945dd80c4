// obstacle-replay --gui on a virtual display: keys go in, the program's own log tells what is shown. Needs Xvfb,
// xdotool and openbox.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "support/shell.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace test {

/// "there", or "" if one of the programs is missing.
inline std::string programs() { return shell("command -v Xvfb xdotool openbox >/dev/null 2>&1") == 0 ? "there" : ""; }

/// "there", or "" if obstacle-replay was built without a window.
inline std::string window() {
    return shell("env -u DISPLAY '" OBSTACLE_REPLAY "' x --gui 2>&1 | grep -q 'built without'") == 0 ? "" : "there";
}

}  // namespace test

namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using test::shell;
using testing::HasSubstr;

bool waitUntil(const std::function<bool()>& condition, std::chrono::seconds limit = 60s) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(20ms);
    }
    return true;
}

/// A program that is ended with the object.
class Process {
  public:
    explicit Process(const std::string& command) : pid_(fork()) {
        if (pid_ == 0) {
            execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
            _exit(127);
        }
    }
    ~Process() {
        if (running()) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
    }
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    bool running() {
        int status = 0;
        if (!code_ && waitpid(pid_, &status, WNOHANG) == pid_) code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        return !code_;
    }
    /// Exit code; -2 if it does not end.
    int wait() {
        return waitUntil([this] { return !running(); }) ? *code_ : -2;
    }

  private:
    pid_t pid_;
    std::optional<int> code_;
};

class Window : public testing::Test {
  protected:
    void SetUp() override {
#if defined(__SANITIZE_ADDRESS__)
        GTEST_SKIP() << "GTK is not clean under AddressSanitizer";
#endif
        LIDAR_OBSTACLES_NEED(built, window());
        LIDAR_OBSTACLES_NEED(tools, programs());
        const std::string number = folder_.file("display");
        x_ = std::make_unique<Process>("Xvfb -displayfd 3 -screen 0 1280x1024x24 3>'" + number + "' >/dev/null 2>&1");
        ASSERT_TRUE(waitUntil([&] { return test::readFile(number).find('\n') != std::string::npos; }));
        display_ = "DISPLAY=:" + test::readFile(number).substr(0, test::readFile(number).find('\n'));
        manager_ = std::make_unique<Process>("env " + display_ + " openbox >/dev/null 2>&1");
    }

    /// Starts the replay and waits for its first picture.
    void open(const std::string& arguments = "") {
        replay_ =
            std::make_unique<Process>("env -C '" + folder_.file("") + "' " + display_ +
                                      " '" OBSTACLE_REPLAY "' '" STREET_SAMPLE ".rawlog' --gui --gui-log '" +
                                      folder_.file("log") + "' " + arguments + " >'" + folder_.file("out") + "' 2>&1");
        ASSERT_TRUE(waitUntil([&] { return !replay_->running() || state().value("drawn", false); }));
        ASSERT_TRUE(replay_->running()) << test::readFile(folder_.file("out"));
        ASSERT_TRUE(waitUntil(
            [&] { return xdotool("search --sync --onlyvisible --name obstacle-replay windowfocus --sync") == 0; }));
    }

    int xdotool(const std::string& words) {
        return shell(display_ + " timeout 20 xdotool " + words + " >/dev/null 2>&1");
    }
    void press(const std::string& keys) { EXPECT_EQ(xdotool("key --delay 30 " + keys), 0) << keys; }
    /// What the mouse does over the window, each time elsewhere: two presses at one place are a double click.
    void mouse(const std::string& words) {
        place_ += 30;
        EXPECT_EQ(xdotool("search --onlyvisible --name obstacle-replay mousemove --window %1 " +
                          std::to_string(place_) + " 300 " + words),
                  0);
    }
    /// At the pace of a hand: the window manager looks at the press first, and holds up what follows at once.
    void drag() {
        mouse(
            "sleep 0.1 mousedown 1 sleep 0.1 mousemove_relative --sync 40 0 sleep 0.1 "
            "mousemove_relative --sync 40 10 sleep 0.1 mouseup 1");
    }

    /// The last line of the log.
    json state() {
        std::string text = test::readFile(folder_.file("log"));
        text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n'));
        const std::size_t begin = text.rfind('\n');
        const json last = json::parse(text.substr(begin == std::string::npos ? 0 : begin + 1), nullptr, false);
        return last.is_object() ? last : json::object();
    }
    /// Waits until the window shows that.
    testing::AssertionResult shows(const std::string& key, const json& value) {
        if (waitUntil([&] { return state()[key] == value; }, 20s)) return testing::AssertionSuccess();
        return testing::AssertionFailure() << key << " is " << state()[key] << " and not " << value;
    }
    testing::AssertionResult showsLayer(const std::string& layer, bool on) {
        if (waitUntil([&] { return state()["layers"].contains(layer) == on; }, 20s)) return testing::AssertionSuccess();
        return testing::AssertionFailure() << layer << ": " << state()["layers"];
    }

    /// Turns each layer on and off by its key.
    void turnEachLayer() {
        const std::vector<std::pair<std::string, std::string>> keys = {
            {"r", "raw"},    {"g", "ground"},     {"a", "candidates"}, {"z", "filtered"}, {"k", "voxels"},
            {"m", "grid"},   {"n", "morphology"}, {"u", "clusters"},   {"x", "rejected"}, {"e", "fit"},
            {"d", "labels"}, {"y", "truth"},      {"3", "tracks"},
        };
        for (const auto& [key, layer] : keys) {
            press(key);
            EXPECT_TRUE(showsLayer(layer, true));
            EXPECT_EQ(state()["layers"][layer].get<int>() > 0, layer != "voxels" && layer != "filtered") << layer;
            press(key);
            EXPECT_TRUE(showsLayer(layer, false));
        }
    }

    int place_ = 300;  ///< of the mouse, from the window's left edge [pixels]
    test::TempFolder folder_;
    std::string display_;
    std::unique_ptr<Process> x_;
    std::unique_ptr<Process> manager_;
    std::unique_ptr<Process> replay_;
};

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
