// SPDX-License-Identifier: BSD-3-Clause
// Poses, de-skewing and 3D filters from end to end: the tools, on the sample street.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"
#include "support/rawlog_files.h"
#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

class MotionReplay : public testing::Test {
  protected:
    /// Exit code; standard error goes to `err`.
    int run(const std::string& command) {
        const int code = test::shell(command + " > /dev/null 2> " + folder_.file("err"));
        err_ = test::readFile(folder_.file("err"));
        return code;
    }
    int replay(const std::string& options) {
        return run(std::string(OBSTACLE_REPLAY) + " " SAMPLE " --output " + folder_.file("out") + " " + options);
    }
    nlohmann::json summary() const { return nlohmann::json::parse(test::readFile(folder_.file("out/summary.json"))); }

    test::TempFolder folder_;
    std::string err_;
};

TEST_F(MotionReplay, TheSummarySaysWhatWasUsed) {
    ASSERT_EQ(replay("--set deskew.enabled=true --set octomap.mode=spurious --set grid.scans=2"), 0) << err_;
    const auto s = summary();
    EXPECT_EQ(s["ego"]["source"], "ego_rtk");
    EXPECT_EQ(s["ego"]["kind"], "pose");
    EXPECT_GT(s["ego"]["poses"], 0);
    EXPECT_EQ(s["deskew"]["scans"]["done"], s["scans"]);
    EXPECT_EQ(s["octomap"]["mode"], "spurious");
    EXPECT_EQ(s["octomap"]["scans"], s["scans"]);
    EXPECT_EQ(s["multi_scan_grid"]["scans_per_grid"], 2);
    EXPECT_TRUE(s["timing_ms"].contains("filter"));
}

TEST_F(MotionReplay, NothingIsUsedWhereNothingIsAskedFor) {
    ASSERT_EQ(replay("--to 1 --set tracking.enabled=false"), 0) << err_;
    const auto s = summary();
    EXPECT_TRUE(s["ego"]["source"].is_null());
    EXPECT_EQ(s["octomap"]["scans"], 0);
    EXPECT_FALSE(s["timing_ms"].contains("filter"));
}

TEST_F(MotionReplay, WithoutPosesItGoesOnAndSaysSo) {
    ASSERT_EQ(replay("--set deskew.enabled=true --set octomap.mode=spurious --set ego.source=none"), 0) << err_;
    const auto s = summary();
    EXPECT_EQ(s["ego"]["kind"], "none");
    EXPECT_EQ(s["deskew"]["scans"]["no_poses"], s["scans"]);
}

TEST_F(MotionReplay, WithoutPosesItSaysOnceThatTracksHaveNoVelocities) {
    ASSERT_EQ(replay("--set ego.source=none"), 0) << err_;
    EXPECT_THAT(std::string(summary()["remarks"]), testing::HasSubstr("tracks have no velocities"));
    EXPECT_THAT(err_, testing::HasSubstr("ego.source=matching"));
    ASSERT_EQ(replay(""), 0) << err_;
    EXPECT_THAT(err_, testing::Not(testing::HasSubstr("no velocities")));
    ASSERT_EQ(replay("--set ego.source=none --set tracking.enabled=false"), 0) << err_;
    EXPECT_THAT(err_, testing::Not(testing::HasSubstr("no velocities")));
}

TEST_F(MotionReplay, PosesFromTheScansAreToldWithTheirResidual) {
    // the last two scans are 2 s apart, the vehicle waits
    const std::string options = "--from 6 --set ego.source=matching --set ego.max_gap=3 --set ego.max_speed=10";
    ASSERT_EQ(replay(options), 0) << err_;
    const auto s = summary();
    EXPECT_EQ(s["ego"]["kind"], "matching");
    EXPECT_EQ(s["ego"]["matching"]["scans"]["first"], 1);
    EXPECT_EQ(s["ego"]["matching"]["scans"]["matched"], 1);
    EXPECT_EQ(s["ego"]["poses"], 2);
    EXPECT_LT(s["ego"]["matching"]["median_residual"], 0.1);
    EXPECT_GT(s["ego"]["matching"]["median_overlap"], 0.3);
    EXPECT_TRUE(s["timing_ms"].contains("match"));
    const std::string command = std::string(OBSTACLE_REPLAY) + " " SAMPLE " " + options + " --output " +
                                folder_.file("out") + " > " + folder_.file("said");
    ASSERT_EQ(test::shell(command), 0);
    EXPECT_THAT(test::readFile(folder_.file("said")), testing::HasSubstr("poses: from the scans themselves"));
}

TEST_F(MotionReplay, AMapIsNotBuiltFromPosesThatOnlyOneRunKnows) {
    EXPECT_EQ(run(std::string(OCTOMAP_BUILD) + " " SAMPLE " " + folder_.file("map.bt") + " --set ego.source=matching"),
              2);
    EXPECT_THAT(err_, testing::HasSubstr("matching"));
}

TEST_F(MotionReplay, AnUnknownSourceOfPosesIsAnErrorThatListsThem) {
    EXPECT_EQ(replay("--set deskew.enabled=true --set ego.source=rtk"), 2);
    EXPECT_THAT(err_, testing::AllOf(testing::HasSubstr("rtk"), testing::HasSubstr("'ego_rtk' (pose)")));
}

TEST_F(MotionReplay, AMapIsBuiltAndTakesOutWhatIsInIt) {
    const std::string map = folder_.file("street.bt");
    ASSERT_EQ(run(std::string(OCTOMAP_BUILD) + " " SAMPLE " " + map + " --set octomap.range=25"), 0) << err_;
    EXPECT_EQ(err_, "");
    ASSERT_EQ(replay("--set octomap.mode=off"), 0);
    const auto without = summary()["obstacles"]["vehicle"].get<int>();
    ASSERT_EQ(replay("--scenes all --set octomap.mode=static --set octomap.map=" + map), 0) << err_;
    // a few scans of a street: what one of them sees beyond 25 m is not in the map
    EXPECT_LT(summary()["obstacles"]["vehicle"].get<int>(), without * 2 / 3);
    EXPECT_GT(summary()["octomap"]["filtered_returns"], 1000);
    mrpt::opengl::COpenGLScene scene;
    ASSERT_TRUE(scene.loadFromFile(folder_.file("out/scene_000000.3Dscene")));
    EXPECT_TRUE(scene.getByName("filter_voxels"));
    EXPECT_TRUE(scene.getByName("filtered"));
}

/// The sample with scans of another calibration than any sensor has, or without these scans.
test::Objects sampleWithBadScans(const std::vector<std::size_t>& objects, bool keep) {
    RawlogReader sample(SAMPLE);
    test::Objects all;
    while (const auto item = sample.next()) {
        const bool is_bad = std::find(objects.begin(), objects.end(), item->object) != objects.end();
        if (is_bad) {
            if (!keep) continue;
            auto& scan = dynamic_cast<test::VelodyneScan&>(*item->observation);
            scan.calibration.laser_corrections.at(3).azimuthCorrection = 1000.0;
        }
        all.push_back(item->observation);
    }
    return all;
}

/// Numbers of the objects of the sample that are scans.
std::vector<std::size_t> scansOfSample() {
    RawlogReader sample(SAMPLE);
    std::vector<std::size_t> objects;
    while (const auto item = sample.next())
        if (dynamic_cast<const test::VelodyneScan*>(item->observation.get())) objects.push_back(item->object);
    return objects;
}

TEST_F(MotionReplay, ABadScanIsNamedAndTheMapIsThatOfTheOthers) {
    const std::vector<std::size_t> scans = scansOfSample();
    ASSERT_GT(scans.size(), 5U);
    const std::vector<std::size_t> bad = {scans[2], scans[4]};
    test::writeRawlog(folder_.file("bad.rawlog"), sampleWithBadScans(bad, true), true);
    test::writeRawlog(folder_.file("good.rawlog"), sampleWithBadScans(bad, false), true);
    const auto build = [&](const std::string& name) {
        return run(std::string(OCTOMAP_BUILD) + " " + folder_.file(name + ".rawlog") + " " +
                   folder_.file(name + ".bt") + " --set octomap.range=15 --set octomap.resolution=0.4");
    };
    ASSERT_EQ(build("good"), 0) << err_;
    EXPECT_EQ(build("bad"), 1);
    EXPECT_THAT(err_, testing::HasSubstr("2 scans that cannot be right left out, the first: "));
    EXPECT_THAT(err_, testing::HasSubstr("bad.rawlog: object " + std::to_string(bad[0]) + " (scan 2): "));
    ASSERT_FALSE(test::readFile(folder_.file("good.bt")).empty());
    EXPECT_TRUE(test::readFile(folder_.file("bad.bt")) == test::readFile(folder_.file("good.bt")));

    test::writeRawlog(folder_.file("none.rawlog"), sampleWithBadScans(scans, true), true);
    EXPECT_EQ(build("none"), 1);
    EXPECT_THAT(err_, testing::HasSubstr(std::to_string(scans.size()) + " scans that cannot be right left out"));
    EXPECT_FALSE(std::filesystem::exists(folder_.file("none.bt")));
}

TEST_F(MotionReplay, BadCommandLinesOfOctomapBuildAreNamed) {
    EXPECT_EQ(run(std::string(OCTOMAP_BUILD) + " " SAMPLE " map.txt"), 2);
    EXPECT_THAT(err_, testing::HasSubstr(".bt or .ot"));
    EXPECT_EQ(run(std::string(OCTOMAP_BUILD) + " " SAMPLE " " + folder_.file("m.bt") + " --set ego.source=none"), 2);
    EXPECT_THAT(err_, testing::HasSubstr("no poses"));
    EXPECT_EQ(run(std::string(OCTOMAP_BUILD) + " /no/such.rawlog " + folder_.file("m.bt")), 1);
    EXPECT_EQ(replay("--set octomap.mode=static"), 2);
    EXPECT_EQ(replay("--set octomap.mode=static --set octomap.map=/no/map.bt"), 1);
}

}  // namespace
}  // namespace lidar_obstacles
