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
    Pixels pixelsOf(const std::string& file) {
        mrpt::img::CImage picture;
        Pixels pixels;
        try {
            if (!picture.loadFromFile(file)) return pixels;
        } catch (const std::exception&) {  // it is still being written
            return pixels;
        }
        for (unsigned y = 0; y < picture.getHeight(); ++y)
            for (unsigned x = 0; x < picture.getWidth(); ++x) {
                const auto* bgr = picture.ptrLine<std::uint8_t>(y) + 3 * x;
                pixels.bright += bgr[0] + bgr[1] + bgr[2] > 384 ? 1 : 0;
                pixels.title += y > 10 && y < 26 && x > 800 && bgr[0] > bgr[2] + 30 ? 1 : 0;
            }
        return pixels;
    }
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
    std::this_thread::sleep_for(1s);  // some scans
    const std::string first = folder_.file("screenshot_live_0.png"), second = folder_.file("screenshot_live_1.png");
    press("s");
    ASSERT_TRUE(waitUntil([&] { return pixelsOf(first).bright > 1000; })) << "nothing is drawn";
    EXPECT_LT(pixelsOf(first).title, 500U);
    press("4 s");
    ASSERT_TRUE(waitUntil([&] { return pixelsOf(second).title > 1000; })) << "the table";
    const std::string third = folder_.file("screenshot_live_2.png");
    press("F6 s");
    ASSERT_TRUE(waitUntil([&] { return pixelsOf(third).bright > 350000; })) << "light: half of the window at least";
    press("q");
    EXPECT_EQ(live.wait(), 0) << test::readFile(folder_.file("err"));
}

}  // namespace
}  // namespace lidar_obstacles
