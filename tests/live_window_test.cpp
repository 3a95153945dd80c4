// SPDX-License-Identifier: BSD-3-Clause
// obstacle-live --window on a virtual display.
#include "support/window_fixture.h"

namespace lidar_obstacles {
namespace {

using test::waitUntil;
using namespace std::chrono_literals;

class LiveWindow : public test::WindowTest {
  protected:
    /// The address that it listens on; "" until it does.
    std::string endpoint() {
        const std::string text = test::readFile(folder_.file("err"));
        const std::size_t at = text.find("listening on ");
        if (at == std::string::npos || text.find(',', at) == std::string::npos) return "";
        return text.substr(at + 13, text.find(',', at) - at - 13);
    }
    /// Pixels of a picture: bright ones, and those of the blue title of a panel at its upper right.
    struct Pixels {
        std::size_t bright = 0, title = 0;
    };
    std::optional<Pixels> pixelsOf(const std::string& file) {
        mrpt::img::CImage picture;
        try {
            if (!picture.loadFromFile(file)) return std::nullopt;
        } catch (const std::exception&) {  // it is still being written
            return std::nullopt;
        }
        Pixels pixels;
        for (unsigned y = 0; y < picture.getHeight(); ++y)
            for (unsigned x = 0; x < picture.getWidth(); ++x) {
                const auto* bgr = picture.ptrLine<std::uint8_t>(y) + 3 * x;
                pixels.bright += bgr[0] + bgr[1] + bgr[2] > 384 ? 1 : 0;
                pixels.title += y > 10 && y < 26 && x > 800 && bgr[0] > bgr[2] + 30 ? 1 : 0;
            }
        return pixels;
    }
    /// Takes screenshots until one shows that: on a busy machine the first ones come before the first scan.
    bool pictureShows(const std::function<bool(const Pixels&)>& condition) {
        return waitUntil([&] {
            press("s");
            const std::string file = folder_.file("screenshot_live_" + std::to_string(pictures_) + ".png");
            std::optional<Pixels> pixels;
            if (!waitUntil([&] { return (pixels = pixelsOf(file)).has_value(); }, 10s)) return false;
            ++pictures_;
            return condition(*pixels);
        });
    }

    int pictures_ = 0;  ///< screenshots taken
};

TEST_F(LiveWindow, HasKeysTableAndZonesAndEndsTheProgramWhenItIsClosed) {
    test::writeFile(folder_.file("zones.yaml"),
                    "zones:\n  - {name: stop, polygon: [[4, -1], [9, -1], [9, 1], [4, 1]]}\n");
    test::Process live("env -C '" + folder_.file("") + "' " + display_ +
                       " '" OBSTACLE_LIVE "' --listen 127.0.0.1:0 --window --zones zones.yaml >'" +
                       folder_.file("out") + "' 2>'" + folder_.file("err") + "'");
    ASSERT_TRUE(waitUntil([&] { return !live.running() || !endpoint().empty(); }));
    ASSERT_TRUE(live.running()) << test::readFile(folder_.file("err"));
    test::Process sender("'" VELODYNE_SEND "' '" STREET_SAMPLE ".rawlog' --to " + endpoint() +
                         " --duration 60 >/dev/null 2>&1");
    ASSERT_TRUE(
        waitUntil([&] { return xdotool("search --sync --onlyvisible --name obstacle-live windowfocus --sync") == 0; }));
    EXPECT_TRUE(pictureShows([](const Pixels& p) { return p.bright > 1000 && p.title < 500; })) << "nothing is drawn";
    press("4");
    EXPECT_TRUE(pictureShows([](const Pixels& p) { return p.title > 1000; })) << "the table";
    press("4 p");
    EXPECT_TRUE(pictureShows([](const Pixels& p) { return p.title > 1000; })) << "the parameters";
    press("plus");  // of the first one
    const auto told = [&](const std::string& text) {
        return waitUntil([&] { return test::readFile(folder_.file("err")).find(text) != std::string::npos; });
    };
    EXPECT_TRUE(told("the window changed pipeline.algorithm=16-plane")) << test::readFile(folder_.file("err"));
    press("w Return");
    EXPECT_TRUE(waitUntil([&] {
        return test::readFile(folder_.file("config.ini")).find("algorithm = 16-plane") != std::string::npos;
    })) << test::readFile(folder_.file("config.ini"));
    press("F6");
    EXPECT_TRUE(pictureShows([](const Pixels& p) { return p.bright > 350000; }))
        << "light: half of the window at least";
    press("q");
    EXPECT_EQ(live.wait(), 0) << test::readFile(folder_.file("err"));
}

}  // namespace
}  // namespace lidar_obstacles
