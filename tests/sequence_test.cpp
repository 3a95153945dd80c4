// SPDX-License-Identifier: BSD-3-Clause
// The replay window's scans behind a detector with memory: in any order, what a straight run finds.
#include "sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <random>
#include <thread>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "player.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::apps {
namespace {

using testing::HasSubstr;

const ScanSelection kAll{std::nullopt, 0, 1'000'000, 1};
constexpr const char* kStreet = STREET_SAMPLE;  // 8 scans, 2 s apart, poses of 'ego_rtk' in between

/// Each scan by itself: nothing uses poses.
DetectorParams withoutMemory() {
    DetectorParams params;
    params.tracking.enabled = false;
    return params;
}

DetectorParams withMemory() {
    DetectorParams params;
    params.deskew.enabled = true;
    params.octomap.mode = FilterMode::Spurious;
    params.octomap.history = 4;
    params.octomap.min_hits = 2;
    params.grid.scans = 3;
    return params;
}

struct Found {
    PointCloud cloud;
    DetectionResult result;
    std::vector<Eigen::Vector3f> voxels;
};

/// What a run from the first scan to the last finds.
std::vector<Found> straightRun(const std::string& file, const DetectorParams& params) {
    ObstacleDetector detector(params);
    const auto source = openScanSource(file);
    PoseFeed feed(*source, chooseEgoSource(file, params.ego.source), [&](const auto& p) { detector.addPose(p); });
    std::vector<Found> all;
    while (const auto item = feed.next()) {
        if (!item->observation || !isLidarScan(*item->observation)) continue;
        SequenceResult r = detector.process(*toPointCloud(*item->observation, params.sensor));
        all.push_back({std::move(r.cloud), std::move(r.detection), detector.filterVoxels()});
    }
    return all;
}

void expectSame(const ShownScan& shown, const Found& expected) {
    EXPECT_EQ(shown.cloud.xyz, expected.cloud.xyz);
    EXPECT_EQ(shown.result.candidates, expected.result.candidates);
    EXPECT_EQ(shown.result.filtered, expected.result.filtered);
    EXPECT_EQ(shown.voxels.size(), expected.voxels.size());
    ASSERT_EQ(shown.result.obstacles.size(), expected.result.obstacles.size());
    for (std::size_t k = 0; k < expected.result.obstacles.size(); ++k) {
        EXPECT_EQ(shown.result.obstacles[k].box.center, expected.result.obstacles[k].box.center);
        EXPECT_EQ(shown.result.obstacles[k].box.size, expected.result.obstacles[k].box.size);
        EXPECT_EQ(shown.result.obstacles[k].box.yaw, expected.result.obstacles[k].box.yaw);
    }
}

void tickWithAllPoses(Player& player) {
    while (!player.poses()->complete()) std::this_thread::yield();
    player.tick(0.0);
}

class Memory : public testing::Test {
  protected:
    void SetUp() override {
        store_.waitFor(1'000'000);
        ASSERT_EQ(expected_.size(), store_.size());
    }

    const ScanStore store_{kStreet, kAll};
    const std::vector<Found> expected_ = straightRun(kStreet, withMemory());
};

TEST_F(Memory, IsUsedByTheseScans) {
    std::size_t filtered = 0;
    for (const Found& f : expected_) filtered += f.result.filtered.size();
    EXPECT_GT(filtered, 100u);
    DetectorParams no_poses = withMemory();
    no_poses.ego.source = "none";
    const auto alone = straightRun(kStreet, no_poses);
    EXPECT_NE(alone.back().result.candidates, expected_.back().result.candidates);
    EXPECT_NE(alone.back().cloud.xyz, expected_.back().cloud.xyz);
}

TEST_F(Memory, ShowsTheSameHoweverOneCameToAScan) {
    Player player(store_, {withMemory(), {}}, {});
    tickWithAllPoses(player);
    std::mt19937 random(1);
    for (int k = 0; k < 100; ++k) {
        const auto scan = static_cast<std::size_t>(random() % 8);
        switch (random() % 4) {
            case 0:
                player.jump(std::to_string(scan));
                break;
            case 1:
                player.step(-1);
                break;
            default:
                player.step(1);
        }
        player.tick(k);
        ASSERT_FALSE(player.provisional());
        expectSame(*player.shown(), expected_.at(player.shown()->scan_index));
    }
}

TEST_F(Memory, PlayingInALoopShowsTheSame) {
    Player player(store_, {withMemory(), {}}, {});
    player.setLoop(true);
    tickWithAllPoses(player);
    player.play(0.0);
    std::size_t shown = 0;
    for (int k = 1; k < 60; ++k) {
        if (player.tick(0.5 * k)) ++shown;
        ASSERT_FALSE(player.provisional());
        expectSame(*player.shown(), expected_.at(player.shown()->scan_index));
    }
    EXPECT_GT(shown, 20u);
}

TEST_F(Memory, AChangeOfParametersRecomputesWithTheScansBefore) {
    Player player(store_, {withoutMemory(), {}}, {});
    player.jump("6");
    player.tick(0.0);
    EXPECT_EQ(player.shown()->used.find("pose"), std::string::npos);
    EXPECT_EQ(player.poses(), nullptr);
    player.setParams(withMemory());
    tickWithAllPoses(player);
    expectSame(*player.shown(), expected_.at(6));
    EXPECT_THAT(player.shown()->used, HasSubstr("pose: at; de-skewed; 3D filter: "));
    EXPECT_THAT(player.shown()->used, HasSubstr("grid of 3 scans"));
    ASSERT_NE(player.poses(), nullptr);
    EXPECT_EQ(player.poses()->source().label, "ego_rtk");
    DetectorParams other = withMemory();
    other.ego.source = "none";
    player.setParams(other);
    EXPECT_THAT(player.shown()->used, HasSubstr("pose: no_poses; not de-skewed: poses no_poses; 3D filter: "));
    player.setParams(withoutMemory());
    EXPECT_EQ(player.shown()->used, "");
}

TEST_F(Memory, WhatCannotBeLeavesAllAsItWas) {
    Player player(store_, {withMemory(), {}}, {});
    player.tick(0.0);
    DetectorParams params = withMemory();
    params.ego.source = "nobody";
    EXPECT_THROW(player.setParams(params), std::invalid_argument);
    params = withMemory();
    params.octomap.mode = FilterMode::Static;
    EXPECT_THROW(player.setParams(params), std::invalid_argument) << "no map";
    params.octomap.map = "/nonexistent.bt";
    EXPECT_THROW(player.setParams(params), std::runtime_error);
    EXPECT_THROW(Player(store_, {params, {}}, {}), std::runtime_error);
    player.step(1);
    tickWithAllPoses(player);
    expectSame(*player.shown(), expected_.at(1));
}

mrpt::obs::CObservationRobotPose::Ptr poseOf(double time, double x, const char* label = "pose") {
    auto pose = std::make_shared<mrpt::obs::CObservationRobotPose>();
    pose->sensorLabel = label;
    pose->timestamp = mrpt::Clock::fromDouble(time);
    pose->pose.mean.x(x);
    return pose;
}

TEST(Poses, AreThoseAroundAScanWhateverTheirOrder) {
    const test::TempFolder folder;
    test::Objects objects;
    for (const double t : {10.0, 10.1, 10.3, 10.2, 10.4, 10.5, 10.6, 10.7, 12.0}) objects.push_back(poseOf(t, t));
    objects.push_back(poseOf(10.15, std::nan("")));
    test::writeRawlog(folder.file("drive.rawlog"), objects, false);
    const PoseIndex poses(folder.file("drive.rawlog"), "pose");
    while (!poses.complete()) std::this_thread::yield();
    std::vector<double> times;
    for (const StampedPose& p : poses.around(10.2, 10.31)) times.push_back(std::round(10.0 * p.time) / 10.0);
    EXPECT_THAT(times, testing::ElementsAre(10.1, 10.2, 10.3, 10.4, 10.5, 10.6)) << "one before, one beyond its end";
    EXPECT_EQ(poses.around(11.0, 11.2).size(), 1u) << "none of a later time";
    EXPECT_TRUE(poses.around(0.0, 0.1).empty());
    EXPECT_EQ(poses.refused(), 1u);
    EXPECT_EQ(poses.around(0.0, 100.0).size(), 9u);
}

TEST(Poses, OfAutoAreFoundOutByTheThread) {
    const test::TempFolder folder;
    test::writeRawlog(folder.file("poses.rawlog"), {poseOf(10.0, 0.0), poseOf(10.3, 0.0)}, false);
    test::writeRawlog(folder.file("none.rawlog"), {test::scanLabelled("front")}, false);
    const PoseIndex poses(folder.file("poses.rawlog"), "auto");
    while (!poses.covers(10.1)) std::this_thread::yield();
    EXPECT_EQ(poses.source().label, "pose");
    const PoseIndex none(folder.file("none.rawlog"), "auto");
    while (!none.covers(10.1)) std::this_thread::yield();
    EXPECT_EQ(none.source().kind, EgoKind::None);
    EXPECT_TRUE(none.around(0.0, 1e9).empty());
    EXPECT_THROW(PoseIndex(folder.file("poses.rawlog"), "nobody"), std::invalid_argument);
    EXPECT_THROW(PoseIndex("/nonexistent.rawlog", "auto"), std::runtime_error);
}

/// Two scans whose poses end so far behind them in the file that reading up to there takes a while.
class LatePoses : public testing::Test {
  protected:
    void SetUp() override {
        test::Objects objects{poseOf(999.9, 0.0)};
        for (int k = 0; k < 2; ++k) {
            auto scan = std::make_shared<test::VelodyneScan>(test::makeScan({}, test::wallAt(10.0 + k)));
            scan->sensorLabel = "front";
            scan->timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * k);
            objects.push_back(scan);
        }
        const auto other = poseOf(1000.0, 0.0, "other");
        for (int k = 0; k < 300'000; ++k) objects.push_back(other);
        for (int k = 1; k < 5; ++k) objects.push_back(poseOf(999.9 + 0.1 * k, 0.1 * k));
        test::writeRawlog(folder_.file("drive.rawlog"), objects, true);
        params_.deskew.enabled = true;
        params_.ego.source = "pose";
        store_.emplace(folder_.file("drive.rawlog"), kAll);
        ASSERT_TRUE(store_->waitFor(1));
    }
    static void tickUntilReady(Player& player) {
        for (; player.provisional() || player.seeking(); std::this_thread::yield()) player.tick(0.0);
    }

    test::TempFolder folder_;
    DetectorParams params_;
    std::optional<ScanStore> store_;
};

TEST_F(LatePoses, TheFirstScanDoesNotWaitForThemButTheNextOneDoes) {
    Player player(*store_, {params_, {}}, {});
    EXPECT_TRUE(player.tick(0.0));
    EXPECT_TRUE(player.provisional());
    EXPECT_THAT(player.shown()->used, HasSubstr("not de-skewed"));
    player.step(1);
    player.tick(0.0);
    EXPECT_TRUE(player.seeking());
    EXPECT_EQ(player.shown()->scan_index, 0u);
    tickUntilReady(player);
    EXPECT_EQ(player.shown()->scan_index, 1u);
    EXPECT_EQ(player.shown()->used, "pose: at; de-skewed");
    player.first();
    player.tick(0.0);
    EXPECT_EQ(player.shown()->scan_index, 0u);
    EXPECT_EQ(player.shown()->used, "pose: at; de-skewed") << "found anew";
}

TEST_F(LatePoses, AChangeOfParametersDoesNotWaitForThem) {
    Player player(*store_, {}, {});
    player.tick(0.0);
    player.setParams(params_);
    EXPECT_TRUE(player.provisional());
    EXPECT_THAT(player.shown()->used, HasSubstr("not de-skewed"));
    tickUntilReady(player);
    EXPECT_EQ(player.shown()->used, "pose: at; de-skewed");
}

TEST_F(LatePoses, AreNotWaitedForWhereNoneAreUsed) {
    Player player(*store_, {params_, {}}, {});
    player.tick(0.0);
    player.setParams(withoutMemory());
    EXPECT_FALSE(player.provisional());
    player.step(1);
    player.tick(0.0);
    EXPECT_EQ(player.shown()->scan_index, 1u);
}

}  // namespace
}  // namespace lidar_obstacles::apps
