// SPDX-License-Identifier: BSD-3-Clause
// The detector behind a live sensor: poses from elsewhere, and what is said without them.
#include "lidar_obstacles/live/live_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "support/velodyne_packets.h"

namespace lidar_obstacles::live {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// When scan `index` begins.
double beginOf(std::size_t index) { return 1000.0 + 0.1 * static_cast<double>(index); }

/// Scan `index` of a sensor that turns ten times a second; the room is round.
LiveScan scanNumber(std::size_t index) {
    auto scan = std::make_shared<test::VelodyneScan>(test::makeScan({}, test::sphere(20.0)));
    scan->timestamp = mrpt::Clock::fromDouble(beginOf(index));
    return {scan, index, 0.0};
}

StampedPose poseAt(double time, double x) {
    StampedPose pose;
    pose.time = time;
    pose.position.x() = x;
    return pose;
}

/// A detector with what its logger told.
class Told : public LiveDetector {
  public:
    explicit Told(const DetectorParams& params) : LiveDetector(params) {
        logRegisterCallback([this](std::string_view text, mrpt::system::VerbosityLevel level, auto, auto) {
            EXPECT_EQ(level, mrpt::system::LVL_WARN);
            texts_.emplace_back(text);
        });
    }
    /// What was told since the last call.
    std::vector<std::string> take() { return std::exchange(texts_, {}); }

  private:
    std::vector<std::string> texts_;
};

DetectorParams everything() {
    DetectorParams params;
    params.deskew.enabled = true;
    params.octomap.mode = FilterMode::Spurious;
    params.grid.scans = 2;
    return params;
}

TEST(LiveDetector, WithTheDefaultsOnlyTracksMissThePoses) {
    DetectorParams params;
    Told detector(params);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_FALSE(detector.process(scanNumber(k)).cloud.empty());
    EXPECT_THAT(detector.take(), ElementsAre("no poses are known: tracks have no velocities")) << "told once";
    params.tracking.enabled = false;
    Told alone(params);
    alone.process(scanNumber(0));
    EXPECT_THAT(alone.take(), IsEmpty());
}

TEST(LiveDetector, PrintsNothingUnlessItIsAskedTo) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    LiveDetector quiet{DetectorParams{}};
    quiet.process(scanNumber(0));
    EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "");

    testing::internal::CaptureStdout();
    LiveDetector loud{DetectorParams{}};
    loud.logging_enable_console_output = true;
    loud.process(scanNumber(0));
    EXPECT_THAT(testing::internal::GetCapturedStdout(), AllOf(HasSubstr("LiveDetector"), HasSubstr("no poses")));
}

TEST(LiveDetector, WhatIsDoneWithoutPosesIsToldOnce) {
    Told detector(everything());
    for (std::size_t k = 0; k < 3; ++k) {
        const SequenceResult found = detector.process(scanNumber(k));
        EXPECT_EQ(found.pose, PoseFound::NoPoses);
        EXPECT_EQ(found.earlier_scans, 0u);
        EXPECT_TRUE(found.filtered);
        const std::size_t told = detector.take().size();
        EXPECT_EQ(told, k == 0 ? 1u : 0u);
    }
}

TEST(LiveDetector, PosesThatAnotherThreadAddsDuringAllScansAreUsed) {
    constexpr int kScans = 30;
    Told detector(everything());
    std::atomic<int> next{0};    // scan
    std::atomic<int> until{-1};  // milliseconds from the beginning
    std::thread odometry([&] {
        for (int ms = 0; ms < 100 * kScans + 300; ++ms) {
            while (ms > 100 * next + 500) std::this_thread::yield();  // not far ahead: it goes on during every scan
            detector.addPose(poseAt(1000.0 + 0.001 * ms, 0.01 * ms));
            until = ms;
        }
    });
    for (int k = 0; k < kScans; ++k) {
        next = k;
        while (until < 100 * k + 200) std::this_thread::yield();
        const SequenceResult found = detector.process(scanNumber(static_cast<std::size_t>(k)));
        EXPECT_EQ(found.pose, PoseFound::At);
        EXPECT_EQ(found.deskewing, Deskewing::Done);
        EXPECT_EQ(found.earlier_scans, k > 0 ? 1u : 0u);
    }
    odometry.join();
    EXPECT_THAT(detector.take(), IsEmpty());
    detector.process(scanNumber(100));  // 7 s after the last pose
    EXPECT_THAT(detector.take(), ElementsAre(HasSubstr("no pose near a scan's time is known")));
}

/// So many poses of a vehicle that stands, 10 ms apart: ten cover a scan.
void addPoses(double from, int count, LiveDetector& detector) {
    for (int i = 0; i < count; ++i) detector.addPose(poseAt(from + 0.01 * i, 0.0));
}

TEST(LiveDetector, PosesThatEndBeforeAScanDoesAreTold) {
    DetectorParams params;
    params.deskew.enabled = true;
    params.ego.max_extrapolation = 0.0;
    Told detector(params);
    for (std::size_t k = 0; k < 3; ++k) {
        addPoses(beginOf(k), 5, detector);  // the first half of a scan
        const SequenceResult found = detector.process(scanNumber(k));
        EXPECT_EQ(found.pose, PoseFound::At);
        EXPECT_EQ(found.deskewing, Deskewing::NoMotion);
    }
    EXPECT_THAT(detector.take(), ElementsAre(HasSubstr("during a whole scan (outside): it is not de-skewed")));
}

TEST(LiveDetector, PosesThatNobodyFetchesAreBoundedAndTheNewestStay) {
    Told detector(everything());
    for (int k = 0; k < 20'000; ++k) detector.addPose(poseAt(1000.0 + 0.01 * k, 0.0));
    EXPECT_NE(detector.process(scanNumber(1990)).pose, PoseFound::NoPoses);
    EXPECT_LE(detector.detector().trajectory().size(), 4096u);
    EXPECT_EQ(detector.detector().trajectory().at(1000.0 + 0.01 * 19'999).found, PoseFound::At);
}

TEST(LiveDetector, PosesOfAnotherEpochAreLeftOutAndToldOnce) {
    for (const double epoch : {2000.0, 0.0}) {  // ahead of the scans and far behind them
        Told detector(everything());
        std::vector<std::string> told;
        for (std::size_t k = 0; k < 50; ++k) {
            addPoses(epoch + 0.1 * static_cast<double>(k), 10, detector);
            detector.process(scanNumber(k));
            EXPECT_LE(detector.detector().trajectory().size(), 12u) << "scan " << k;
            for (std::string& text : detector.take()) told.push_back(std::move(text));
        }
        if (epoch > 0.0)
            EXPECT_THAT(told, ElementsAre(HasSubstr("more than 1 s after the scan"), HasSubstr("no poses are known")));
        else
            EXPECT_THAT(told, ElementsAre(HasSubstr("no pose near a scan's time is known")));
    }
}

TEST(LiveDetector, AStrayPoseOfTheFutureDoesNotHideThoseThatCome) {
    Told detector(everything());
    for (std::size_t k = 0; k < 5; ++k) {
        if (k == 2) detector.addPose(poseAt(1e6, 0.0));
        addPoses(beginOf(k), 10, detector);
        const SequenceResult found = detector.process(scanNumber(k));
        EXPECT_EQ(found.pose, PoseFound::At);
        EXPECT_EQ(found.deskewing, Deskewing::Done);
    }
    EXPECT_THAT(detector.take(), ElementsAre(HasSubstr("more than 1 s after the scan")));
}

TEST(LiveDetector, AClockThatIsPutBackBeginsAnew) {
    Told detector(everything());
    for (const std::size_t k : {98U, 99U, 0U, 1U, 2U}) {
        addPoses(beginOf(k), 10, detector);
        const SequenceResult found = detector.process(scanNumber(k));
        EXPECT_EQ(found.pose, PoseFound::At) << k;
        EXPECT_EQ(found.deskewing, Deskewing::Done) << k;
        EXPECT_EQ(found.restarted, k == 0) << k;
        EXPECT_EQ(found.earlier_scans, k == 98 || k == 0 ? 0u : 1u) << k;
    }
    EXPECT_THAT(detector.take(), IsEmpty());
}

TEST(LiveDetector, AScanThatCannotBeRightChangesNothing) {
    Told detector(everything());
    addPoses(beginOf(0), 10, detector);
    detector.process(scanNumber(0));
    auto broken = std::make_shared<test::VelodyneScan>(test::makeScan({}, test::sphere(20.0)));
    broken->sensorPose.x(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THROW(detector.decode({broken, 1, 0.0}), std::runtime_error);
    addPoses(beginOf(1), 10, detector);
    EXPECT_EQ(detector.process(scanNumber(1)).earlier_scans, 1u);
}

TEST(LiveDetector, APoseThatIsNotFiniteIsRefusedWhereItIsGiven) {
    Told detector(everything());
    EXPECT_THROW(detector.addPose(poseAt(1000.0, std::numeric_limits<double>::quiet_NaN())), std::invalid_argument);
    EXPECT_EQ(detector.process(scanNumber(0)).pose, PoseFound::NoPoses);
}

TEST(DoneWithout, NamesWhatPosesWouldBeUsedFor) {
    EXPECT_EQ(doneWithout(PoseFound::NoPoses, everything()),
              "no poses are known: scans are not de-skewed, a grid holds one scan, "
              "the 3D filter looks at each scan alone, tracks have no velocities");
    DetectorParams params;
    EXPECT_EQ(doneWithout(PoseFound::NoPoses, params), "no poses are known: tracks have no velocities");
    params.tracking.enabled = false;
    EXPECT_EQ(doneWithout(PoseFound::NoPoses, params), "");
    params.octomap.mode = FilterMode::Static;
    EXPECT_EQ(doneWithout(PoseFound::Gap, params), "the poses have a gap: the map of what stands still is not used");
    EXPECT_THAT(doneWithout(PoseFound::Gap, everything()), HasSubstr("the 3D filter looks at each scan alone"));
    EXPECT_EQ(doneWithout(PoseFound::At, everything()),
              "the poses tell the rotation only: a grid holds one scan, the 3D filter looks at each scan alone, "
              "tracks have no velocities");
}

TEST(LiveDetector, AScanThatCannotBeRightTakesNoOtherWithIt) {
    const LiveDetector detector(DetectorParams{});
    const LiveScan good = scanNumber(0);
    auto observation = std::make_shared<test::VelodyneScan>(*good.observation);
    observation->sensorPose.x(std::numeric_limits<double>::quiet_NaN());
    const LiveScan bad{observation, 0, 0.0};
    const std::size_t returns = detector.decode(good).size();
    for (const auto& scans : {std::vector<LiveScan>{good, bad}, std::vector<LiveScan>{bad, good}}) {
        const JoinedDecode decoded = detector.decode(scans);
        ASSERT_TRUE(decoded.cloud);
        EXPECT_EQ(decoded.cloud->size(), returns);
        EXPECT_THAT(decoded.undecodable, ElementsAre(HasSubstr("sensorPose")));
    }
    EXPECT_EQ(detector.decode(std::vector<LiveScan>{good, good}).cloud->size(), 2 * returns);
    EXPECT_FALSE(detector.decode(std::vector<LiveScan>{bad}).cloud);
}

}  // namespace
}  // namespace lidar_obstacles::live
