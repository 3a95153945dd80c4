// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-replay --gui on a virtual display: keys and clicks go in, the program's own log tells what is shown. Needs
/// Xvfb, xdotool and openbox.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

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

namespace test {

using namespace std::chrono_literals;
using nlohmann::json;

inline bool waitUntil(const std::function<bool()>& condition, std::chrono::seconds limit = 60s) {
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

class WindowTest : public testing::Test {
  protected:
    void SetUp() override {
#if defined(__SANITIZE_ADDRESS__)
        GTEST_SKIP() << "the drivers of OpenGL are not clean under AddressSanitizer";
#endif
        LIDAR_OBSTACLES_NEED(built, window());
        LIDAR_OBSTACLES_NEED(tools, programs());
        const std::string number = folder_.file("display");
        x_ = std::make_unique<Process>("Xvfb -displayfd 3 -screen 0 1280x1024x24 3>'" + number + "' >/dev/null 2>&1");
        ASSERT_TRUE(waitUntil([&] { return readFile(number).find('\n') != std::string::npos; }));
        display_ = "DISPLAY=:" + readFile(number).substr(0, readFile(number).find('\n'));
        manager_ = std::make_unique<Process>("env " + display_ + " openbox >/dev/null 2>&1");
    }

    /// Starts the replay of the street and waits for its first picture.
    void open(const std::string& arguments = "") { openFile(STREET_SAMPLE ".rawlog", arguments); }
    void openFile(const std::string& input, const std::string& arguments) {
        replay_ = std::make_unique<Process>(
            "env -C '" + folder_.file("") + "' " + display_ + " '" OBSTACLE_REPLAY "' '" + input +
            "' --gui --gui-log '" + folder_.file("log") + "' " + arguments + " >'" + folder_.file("out") + "' 2>&1");
        ASSERT_TRUE(waitUntil([&] { return !replay_->running() || state().value("drawn", false); }));
        ASSERT_TRUE(replay_->running()) << readFile(folder_.file("out"));
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

    /// A click at a place of the window, at the pace of a hand.
    void click(double x, double y) {
        EXPECT_EQ(xdotool("search --onlyvisible --name obstacle-replay mousemove --window %1 " +
                          std::to_string(static_cast<int>(x)) + " " + std::to_string(static_cast<int>(y)) +
                          " sleep 0.2 mousedown 1 sleep 0.1 mouseup 1 sleep 0.1"),
                  0);
    }
    void click(const json& at) { click(at[0].get<double>(), at[1].get<double>()); }

    /// The last line of the log.
    json state() {
        std::string text = readFile(folder_.file("log"));
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

    /// Takes a screenshot and keeps it under that name where $LIDAR_OBSTACLES_PICTURES names a folder
    /// (scripts/pictures.sh). @return its file.
    std::string takePicture(const std::string& name) {
        press("s");
        const auto message = [this] { return state().value("message", ""); };
        EXPECT_TRUE(waitUntil([&] { return message().find("screenshot: ") == 0; }, 20s)) << message();
        const std::string file = folder_.file(message().substr(std::min<std::size_t>(12, message().size())));
        const char* folder = std::getenv("LIDAR_OBSTACLES_PICTURES");
        if (folder && *folder)
            std::filesystem::copy_file(file, std::filesystem::path(folder) / name,
                                       std::filesystem::copy_options::overwrite_existing);
        return file;
    }

    /// Turns each layer on and off by its key.
    void turnEachLayer() {
        const std::vector<std::pair<std::string, std::string>> keys = {
            {"r", "raw"},      {"g", "ground"}, {"a", "candidates"}, {"z", "filtered"},
            {"k", "voxels"},   {"m", "grid"},   {"n", "morphology"}, {"u", "clusters"},
            {"x", "rejected"}, {"e", "fit"},    {"d", "labels"},     {"y", "truth"},
            {"3", "tracks"},   {"5", "merges"}, {"6", "zones"},      {"7", "region"},
        };
        for (const auto& [key, layer] : keys) {
            press(key);
            EXPECT_TRUE(showsLayer(layer, true));
            EXPECT_EQ(state()["layers"][layer].get<int>() > 0,
                      layer != "voxels" && layer != "filtered" && layer != "zones")
                << layer;
            press(key);
            EXPECT_TRUE(showsLayer(layer, false));
        }
    }

    int place_ = 300;  ///< of the mouse, from the window's left edge [pixels]
    TempFolder folder_;
    std::string display_;
    std::unique_ptr<Process> x_;
    std::unique_ptr<Process> manager_;
    std::unique_ptr<Process> replay_;
};

}  // namespace test
}  // namespace lidar_obstacles
