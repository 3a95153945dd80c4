// SPDX-License-Identifier: BSD-3-Clause
// The replay window without its window: the index of a file, playing and seeking, keys, parameters.
#include "player.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <chrono>
#include <thread>

#include "controls.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/capture_files.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::apps {
namespace {

using test::Objects;
using test::scanLabelled;
using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;

const ScanSelection kAll{std::nullopt, 0, 1'000'000, 1};
constexpr const char* kStreet = STREET_SAMPLE;  // 8 scans, 2 s apart, compressed

/// `count` scans 0.1 s apart, a wall at 10 m, 11 m ...: the distance tells which one it is.
Objects scans(int count) {
    Objects objects;
    for (int k = 0; k < count; ++k) {
        auto scan = std::make_shared<test::VelodyneScan>(test::makeScan({}, test::wallAt(10.0 + k)));
        scan->sensorLabel = "front";
        scan->timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * k);
        objects.push_back(scan);
    }
    return objects;
}

double wallIn(const mrpt::obs::CObservation& scan) {
    double nearest = 1e9;
    const PointCloud cloud = toPointCloud(scan, SensorParams{}).value_or(PointCloud{});
    for (const auto& p : cloud.xyz) nearest = std::min(nearest, static_cast<double>(p.x()));
    return nearest;
}

std::vector<int> wallsBackwards(const ScanStore& store) {
    std::vector<int> walls;
    for (std::size_t k = store.size(); k-- > 0;) walls.push_back(static_cast<int>(std::lround(wallIn(*store.read(k)))));
    return walls;
}

void waitForEnd(const ScanStore& store) { store.waitFor(1'000'000); }

class Store : public testing::Test {
  protected:
    std::string write(const Objects& objects, bool compressed) {
        const std::string file = folder_.file("drive.rawlog");
        test::writeRawlog(file, objects, compressed);
        return file;
    }
    TempFolder folder_;
};

TEST_F(Store, ReadsBackwardsWhateverTheFile) {
    for (const bool compressed : {false, true}) {
        const ScanStore store(write(scans(4), compressed), kAll);
        waitForEnd(store);
        EXPECT_THAT(wallsBackwards(store), ElementsAre(13, 12, 11, 10)) << "compressed: " << compressed;
        EXPECT_EQ(store.problem(), "");
        EXPECT_NEAR(store.time(2), 1000.2, 1e-6);
    }
}

TEST_F(Store, FindsScansInsideSensoryFramesBetweenOtherObservations) {
    auto frame = std::make_shared<mrpt::obs::CSensoryFrame>();
    const Objects two = scans(2);
    frame->insert(scanLabelled("rear"));
    for (const auto& object : two) frame->insert(std::dynamic_pointer_cast<mrpt::obs::CObservation>(object));
    const ScanStore store(write({scanLabelled("rear"), frame, scans(3)[2]}, false), {"front", 0, 1000, 1});
    waitForEnd(store);
    EXPECT_THAT(wallsBackwards(store), ElementsAre(12, 11, 10));
}

TEST_F(Store, ReadsCapturesBackwards) {
    test::CaptureFile capture;
    for (int k = 0; k < 3; ++k) capture.add(test::makeScan({}, test::wallAt(10.0 + k)), 1000.0 + 0.1 * k);
    const std::string file = folder_.file("drive.pcap");
    test::writeFile(file, capture.content());
    const ScanStore store(file, kAll);
    waitForEnd(store);
    EXPECT_THAT(wallsBackwards(store), ElementsAre(12, 11, 10));
}

TEST_F(Store, KeepsTheNumbersOfSelectedScans) {
    const ScanStore store(write(scans(8), false), {std::nullopt, 1, 6, 2});
    waitForEnd(store);
    ASSERT_EQ(store.size(), 3U);
    EXPECT_EQ(store.scanIndex(0), 1U);
    EXPECT_EQ(store.scanIndex(2), 5U);
    EXPECT_EQ(store.atScanIndex(2), 1U);
    EXPECT_EQ(store.atScanIndex(99), 2U);
    EXPECT_EQ(store.atTime(1000.34), 1U);  // scan 3
    EXPECT_EQ(store.atTime(0.0), 0U);
}

TEST_F(Store, LeavesNoFileBehind) {
    setenv("TMPDIR", folder_.file("").c_str(), 1);
    const ScanStore store(write(scans(2), true), kAll);
    waitForEnd(store);
    unsetenv("TMPDIR");
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder_.file(""))) ++files;
    EXPECT_EQ(files, 1U) << "the rawlog alone";
    EXPECT_EQ(wallsBackwards(store).size(), 2U);
}

TEST_F(Store, EndsWhereTheFileIsDamaged) {
    const std::string file = write(scans(3), false);
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 1000);
    const ScanStore store(file, kAll);
    waitForEnd(store);
    EXPECT_EQ(store.size(), 2U);
    EXPECT_THAT(store.problem(), HasSubstr("object 2 cannot be read"));
    EXPECT_FALSE(store.problemOfUsage());
}

TEST_F(Store, SeveralLidarsAndUnknownOnesAreMistakesOfTheCaller) {
    const std::string file = write({scanLabelled("front"), scanLabelled("rear")}, false);
    const ScanStore several(file, kAll);
    waitForEnd(several);
    EXPECT_TRUE(several.problemOfUsage());
    EXPECT_THAT(several.problem(), HasSubstr("several lidars ('front', 'rear' ...), choose one with --sensor-label"));
    const ScanStore unknown(file, {"top", 0, 10, 1});
    waitForEnd(unknown);
    EXPECT_TRUE(unknown.problemOfUsage());
    EXPECT_FALSE(unknown.waitFor(0));
    EXPECT_THROW(ScanStore("/nonexistent.rawlog", kAll), std::runtime_error);
}

class Playing : public Store {
  protected:
    explicit Playing(const std::string& file = kStreet) : store_(file, kAll), player_(store_, {}, {}) {
        waitForEnd(store_);
        const PoseIndex* poses = player_.poses();  // read by a thread of its own
        while (poses && !poses->complete()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        player_.tick(0.0);
    }
    std::size_t shown() const { return player_.shown()->scan_index; }

    ScanStore store_;
    Player player_;
};

TEST_F(Playing, StepsThere100TimesAndBackToTheSameBoxes) {
    const auto boxes = [&] { return player_.shown()->result.obstacles; };
    std::map<std::size_t, std::vector<Obstacle>> first;
    for (int round = 0; round < 100; ++round) {
        player_.step(round / 7 % 2 == 0 ? 1 : -1);  // to the last scan and back; fewer are kept
        player_.tick(round);
        const auto [known, is_new] = first.try_emplace(shown(), boxes());
        ASSERT_EQ(known->second.size(), boxes().size());
        for (std::size_t k = 0; k < boxes().size(); ++k) {
            EXPECT_EQ(known->second[k].box.center, boxes()[k].box.center);
            EXPECT_EQ(known->second[k].box.size, boxes()[k].box.size);
            EXPECT_EQ(known->second[k].box.yaw, boxes()[k].box.yaw);
            EXPECT_EQ(known->second[k].points, boxes()[k].points);
        }
    }
    EXPECT_EQ(first.size(), 8U);
}

TEST_F(Playing, ShowsTheNextScanWhenItIsDue) {
    player_.play(10.0);
    player_.tick(10.5);
    EXPECT_EQ(shown(), 0U);
    player_.tick(11.01);  // 2 s apart, but no wait is longer than a second
    EXPECT_EQ(shown(), 1U);
    player_.faster(11.1);
    player_.tick(11.55);
    EXPECT_EQ(shown(), 1U);
    player_.tick(11.61);
    EXPECT_EQ(shown(), 2U);
}

TEST_F(Playing, StopsAtTheEndOrBeginsAgain) {
    for (int k = 0; k < 20; ++k) player_.faster(0.0);
    player_.play(0.0);
    for (int k = 1; k < 20; ++k) player_.tick(k);
    EXPECT_EQ(shown(), 7U);
    EXPECT_FALSE(player_.playing());
    player_.setLoop(true);
    player_.play(20.0);  // from the end: from the beginning
    player_.tick(21.0);
    EXPECT_EQ(shown(), 0U);
    for (int k = 22; k < 30; ++k) player_.tick(k);
    EXPECT_EQ(shown(), 0U) << "after the last one";
    EXPECT_TRUE(player_.playing());
}

TEST_F(Playing, JumpsToScansAndTimes) {
    const std::vector<std::pair<std::string, std::size_t>> cases = {{"5", 5},    {"0", 0},      {"99", 7},
                                                                    {"4.1s", 2}, {"0:06.5", 3}, {"1000s", 7}};
    for (const auto& [where, scan] : cases) {
        player_.jump(where);
        player_.tick(0.0);
        EXPECT_EQ(shown(), scan) << where;
    }
    for (const char* nonsense : {"", "x", "-3", "1:", "s", "1e999"})
        EXPECT_THROW(player_.jump(nonsense), std::invalid_argument) << nonsense;
    player_.last();
    player_.tick(0.0);
    EXPECT_EQ(shown(), 7U);
    player_.first();
    player_.step(-1);
    player_.tick(0.0);
    EXPECT_EQ(shown(), 0U);
}

TEST_F(Playing, ProcessesTheShownScanWithNewParameters) {
    DetectorParams params;
    params.sensor.max_range = 15.0;
    const std::size_t before = player_.shown()->cloud.size();
    player_.setParams(params);
    EXPECT_TRUE(player_.tick(0.0));
    EXPECT_LT(player_.shown()->cloud.size(), before);
    EXPECT_EQ(player_.shown()->scan_index, 0U);
    params.sensor.planes = 5;  // does not divide 16
    EXPECT_THROW(player_.setParams(params), std::invalid_argument);
    EXPECT_EQ(player_.setup().params.sensor.planes, 0);
    player_.setParams({});
    EXPECT_EQ(player_.shown()->cloud.size(), before);
}

TEST_F(Playing, TruthComesWithItsScan) {
    DetectorParams params;
    params.tracking.enabled = false;  // no poses are waited for
    Player player(store_, {params, {}}, {{1, {{"car 7", {}}}}});
    player.tick(0.0);
    EXPECT_TRUE(player.shown()->truth.empty());
    player.step(1);
    player.tick(0.0);
    ASSERT_EQ(player.shown()->truth.size(), 1U);
    EXPECT_EQ(player.shown()->truth[0].label, "car 7");
}

TEST(DualReturn, OneOfTheTwoCanBeLeftOut) {
    test::VelodyneScan scan = test::makeScan({}, test::sphere(20.0));
    for (auto& packet : scan.scan_packets) {
        packet.laser_return_mode = test::VelodyneScan::RETMODE_DUAL;
        for (int b = 0; b < 12; b += 2) {
            unsigned azimuth = 0;
            std::memcpy(&azimuth, test::bytes(packet) + 100 * b + 2, 2);
            test::setBlock(packet, b + 1, azimuth);                                // pairs share their azimuth
            for (int k = 0; k < 32; ++k) test::setReturn(packet, b + 1, k, 5000);  // strongest at 10 m
        }
    }
    const auto nearAndFar = [&](const DualReturns& dual) {
        std::pair<int, int> counts;
        const auto shown = decodeScan(scan, 0, {{}, dual});
        for (const auto& p : shown->cloud.xyz) ++(p.norm() < 15.F ? counts.first : counts.second);
        return counts;
    };
    const auto both = nearAndFar({true, true});
    EXPECT_GT(both.first, 1000);
    EXPECT_GT(both.second, 1000);
    EXPECT_EQ(nearAndFar({true, false}), std::make_pair(0, both.second));
    EXPECT_EQ(nearAndFar({false, true}), std::make_pair(both.first, 0));
    EXPECT_EQ(nearAndFar({false, false}), std::make_pair(0, 0));
}

class Keys : public Playing {
  protected:
    Keys() : controls_(player_, usualLayers(), PointColor::Height) {}
    void press(const std::string& keys) {
        for (const char key : keys) press(static_cast<int>(key));
    }
    void press(int key) {
        controls_.press({key, false}, 0.0);
        player_.tick(0.0);
    }
    const ViewState& view() const { return controls_.view(); }

    Controls controls_;
};

TEST_F(Keys, EachLayerHasOne) {
    LayerSet flipped;
    for (const char key : std::string("rgazkmnuxeb3dy567")) {
        const LayerSet before = view().layers;
        press(key);
        const LayerSet change = before ^ view().layers;
        EXPECT_EQ(change.count(), 1U) << key;
        flipped |= change;
    }
    EXPECT_TRUE(flipped.all());
    press('4');
    EXPECT_TRUE(view().tracks);
    const LayerSet before = view().layers;
    press('0');
    EXPECT_TRUE(view().layers.all());
    press('0');
    EXPECT_EQ(view().layers, before);
}

TEST_F(Keys, StepSeekAndPlay) {
    press(kRight);
    press(kPageDown);
    EXPECT_EQ(shown(), 7U);
    press(kHome);
    press("j3");
    EXPECT_THAT(view().prompt, HasSubstr("3_"));
    press(kEnter);
    EXPECT_EQ(shown(), 3U);
    press("jx");
    press(kEnter);
    EXPECT_THAT(view().message, HasSubstr("neither a scan number"));
    EXPECT_EQ(view().prompt, "");
    press("j5");
    press(kEscape);
    EXPECT_FALSE(view().quit) << "escape closes the question first";
    EXPECT_EQ(shown(), 3U);
    press(' ');
    EXPECT_TRUE(player_.playing());
    press('l');
    EXPECT_TRUE(player_.loop());
    press(kUp);
    EXPECT_EQ(player_.speed(), 2.0);
    press(kEscape);
    EXPECT_TRUE(view().quit);
}

TEST_F(Keys, ChangeParametersOnlyWhileThePanelIsOpen) {
    const auto algorithm = [&] { return player_.setup().params.pipeline.algorithm; };
    press('+');
    EXPECT_EQ(algorithm(), Algorithm::Auto);
    press("p+");
    EXPECT_EQ(algorithm(), Algorithm::Planes16);
    press('-');
    EXPECT_EQ(algorithm(), Algorithm::Auto);
    while (controls_.panel().chosen() != "grid.fine_resolution") press(kDown);
    press('+');
    EXPECT_EQ(player_.setup().params.grid.fine_resolution, 0.06);
    press(kBackspace);
    EXPECT_EQ(player_.setup().params.grid.fine_resolution, 0.05);
    press(kEnter);
    press("0.25");
    press(kEnter);
    EXPECT_EQ(player_.setup().params.grid.fine_resolution, 0.25);
    EXPECT_EQ(view().message, "");
    press(kEnter);
    press("9");
    press(kEnter);
    EXPECT_THAT(view().message, HasSubstr("out of range"));
    EXPECT_EQ(player_.setup().params.grid.fine_resolution, 0.25);
}

TEST_F(Keys, ARangeEndsAtTheScanThatTheKeyBeforeIsAboutToShow) {
    for (const int key : {int{'/'}, int{kRight}, int{kRight}, int{'/'}}) controls_.press({key, false}, 0.0);
    EXPECT_EQ(player_.range(), (std::pair<std::size_t, std::size_t>(0, 2)));
    press("/");
    EXPECT_EQ(player_.range(), std::nullopt);
    press("//");
    EXPECT_THAT(view().message, HasSubstr("a range ends after it begins"));
}

TEST_F(Keys, SaveTheParameters) {
    press("p");
    while (controls_.panel().chosen() != "grid.free") press(kDown);
    press("+w");
    for (int k = 0; k < 20; ++k) press(kBackspace);  // the name that is offered
    const std::string file = folder_.file("my.ini");
    for (const char c : file) {
        const bool capital = c >= 'A' && c <= 'Z';
        controls_.press({capital ? c - 'A' + 'a' : c == '_' ? '-' : c, capital || c == '_'}, 0.0);
    }
    press(kEnter);
    EXPECT_THAT(view().message, HasSubstr("my.ini"));
    EXPECT_EQ(loadParams(file).grid.free, FreeSpace::Rays);
}

TEST_F(Keys, AreAllInTheHelp) {
    std::string keys;
    for (const KeyHelp& k : keyTable()) keys += k.keys + ",";
    for (const char* key : {"space", "right", "page down", "home", "j", "up", "l", "i, o", "f", "t", "v", "1, 2", "p",
                            "enter", "w", "s", "h", "q"})
        EXPECT_THAT(keys, HasSubstr(key));
}

TEST(Panel, EveryParameterCanGoUpAndDownWithinItsRange) {
    const ParamPanel first;
    ParamPanel panel;
    do {
        DetectorParams params;
        for (const int direction : {1, -1}) {
            for (int k = 0; k < 30; ++k) params = panel.changed(params, direction, k % 5 == 0);
            EXPECT_NO_THROW(panel.typed(params, panel.value(params))) << panel.chosen();
        }
        EXPECT_EQ(panel.value(panel.reset(params)), panel.value(DetectorParams{}));
        panel.choose(1);
    } while (panel.chosen() != first.chosen());
}

}  // namespace
}  // namespace lidar_obstacles::apps
