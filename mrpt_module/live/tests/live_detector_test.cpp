// The detector behind a live sensor: poses from elsewhere, and what is said without them.
#include "lidar_obstacles/live/live_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <thread>

#include "support/velodyne_packets.h"

namespace lidar_obstacles::live {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Scan `index` of a sensor that turns ten times a second; the room is round.
LiveScan scanNumber(std::size_t index) {
    auto scan = std::make_shared<test::VelodyneScan>(test::makeScan({}, test::sphere(20.0)));
    scan->timestamp = mrpt::Clock::fromDouble(1000.0 + 0.1 * static_cast<double>(index));
    return {scan, index, 0.0};
}

StampedPose poseAt(double time, double x) {
    StampedPose pose;
    pose.time = time;
    pose.position.x() = x;
    return pose;
}

DetectorParams everything() {
    DetectorParams params;
    params.deskew.enabled = true;
    params.octomap.mode = FilterMode::Spurious;
    params.grid.scans = 2;
    return params;
}

TEST(LiveDetector, WithTheDefaultsThereIsNothingToSayOfPoses) {
    LiveDetector detector(DetectorParams{});
    EXPECT_FALSE(detector.process(scanNumber(0)).cloud.empty());
    EXPECT_THAT(detector.takeReports(), IsEmpty());
}

TEST(LiveDetector, WhatIsDoneWithoutPosesIsToldOnce) {
    LiveDetector detector(everything());
    for (std::size_t k = 0; k < 3; ++k) {
        const SequenceResult found = detector.process(scanNumber(k));
        EXPECT_EQ(found.pose, PoseFound::NoPoses);
        EXPECT_EQ(found.earlier_scans, 0u);
        EXPECT_TRUE(found.filtered);
        const std::size_t told = detector.takeReports().size();
        EXPECT_EQ(told, k == 0 ? 1u : 0u);
    }
}

TEST(LiveDetector, PosesFromAnotherThreadAreUsed) {
    LiveDetector detector(everything());
    for (std::size_t k = 0; k < 4; ++k) {
        std::thread odometry([&] {
            for (int i = 0; i < 10; ++i) {
                const double t = 0.1 * static_cast<double>(k) + 0.01 * i;
                detector.addPose(poseAt(1000.0 + t, 10.0 * t));
            }
        });
        odometry.join();  // up to the end of the scan; its very last returns need a pose beyond
        const SequenceResult found = detector.process(scanNumber(k));
        EXPECT_EQ(found.pose, PoseFound::At);
        EXPECT_EQ(found.deskewing, Deskewing::Done);
        EXPECT_EQ(found.earlier_scans, k > 0 ? 1u : 0u);
    }
    EXPECT_THAT(detector.takeReports(), IsEmpty());
    detector.process(scanNumber(100));  // 10 s after the last pose
    EXPECT_THAT(detector.takeReports(), ElementsAre(HasSubstr("no pose near a scan's time is known")));
}

TEST(LiveDetector, PosesThatNobodyFetchesAreBoundedAndTheNewestStay) {
    LiveDetector detector(everything());
    for (int k = 0; k < 20'000; ++k) detector.addPose(poseAt(1000.0 + 0.01 * k, 0.0));
    EXPECT_NE(detector.process(scanNumber(0)).pose, PoseFound::At) << "the first scan's are gone";
    EXPECT_LE(detector.detector().trajectory().size(), 4096u);
    EXPECT_EQ(detector.detector().trajectory().lastTime(), 1000.0 + 0.01 * 19'999);
}

TEST(LiveDetector, APoseThatIsNotFiniteIsRefusedWhereItIsGiven) {
    LiveDetector detector(everything());
    EXPECT_THROW(detector.addPose(poseAt(1000.0, std::numeric_limits<double>::quiet_NaN())), std::invalid_argument);
    EXPECT_EQ(detector.process(scanNumber(0)).pose, PoseFound::NoPoses);
}

TEST(DoneWithout, NamesWhatPosesWouldBeUsedFor) {
    EXPECT_EQ(doneWithout(PoseFound::NoPoses, everything()),
              "no poses are known: scans are not de-skewed, a grid holds one scan, "
              "the 3D filter looks at each scan alone");
    DetectorParams params;
    EXPECT_EQ(doneWithout(PoseFound::NoPoses, params), "");
    params.octomap.mode = FilterMode::Static;
    EXPECT_EQ(doneWithout(PoseFound::Gap, params), "the poses have a gap: the map of what stands still is not used");
    EXPECT_THAT(doneWithout(PoseFound::Gap, everything()), HasSubstr("the 3D filter looks at each scan alone"));
    EXPECT_EQ(doneWithout(PoseFound::At, everything()),
              "the poses tell the rotation only: a grid holds one scan, the 3D filter looks at each scan alone");
}

}  // namespace
}  // namespace lidar_obstacles::live
