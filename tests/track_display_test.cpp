// SPDX-License-Identifier: BSD-3-Clause
// Tracks as they are shown: tails behind them, and the table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lidar_obstacles/mrpt_bridge/track_tails.h"
#include "overlay.h"

namespace lidar_obstacles {
namespace {

using apps::ShownScan;
using apps::tracksText;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Obstacle track(int id, double x, double y) {
    Obstacle o;
    o.id = id;
    o.cls = ObstacleClass::Vehicle;
    o.probability[static_cast<std::size_t>(o.cls)] = 0.9F;
    o.box = {{x, y, 0.75}, {4.0, 2.0, 1.5}, 0.0};
    o.track.emplace();
    o.track->age = 2.5;
    o.track->velocity = Eigen::Vector2d(5.0, 0.0);
    o.track->moving = true;
    return o;
}

/// A vehicle at 10 m/s along x; what is told is told as of the scan's timestamp.
class Tails : public testing::Test {
  protected:
    Tails() : trajectory_(EgoParams{}) {
        for (int k = 0; k < 100; ++k) {
            StampedPose pose;
            pose.time = 100.0 + 0.1 * k;
            pose.position.x() = k;
            trajectory_.add(pose);
        }
    }

    /// Scan k with a parked car, and a van that drives at 5 m/s, each where the vehicle sees it.
    void add(int k, bool with_van = true, double delay = 0.0) {
        SequenceResult found;
        found.cloud.timestamp = 100.0 + 0.1 * k;
        const double gone = k + 10.0 * delay;
        found.detection.obstacles = {track(1, 30.0 - gone, 3.0)};
        if (with_van) found.detection.obstacles.push_back(track(2, 20.0 - gone + 0.5 * k + 5.0 * delay, -3.0));
        for (Obstacle& o : found.detection.obstacles) o.track->time_offset = delay;
        Obstacle wall;
        wall.cls = ObstacleClass::Structure;
        found.detection.obstacles.push_back(wall);
        tails_.add(found, trajectory_);
    }

    Trajectory trajectory_;
    TrackTails tails_{1.0};
};

TEST_F(Tails, AreTheWayOverGroundInTheFrameOfTheBox) {
    add(0);
    EXPECT_TRUE(tails_.tails().empty()) << "a way has two ends";
    for (int k = 1; k <= 4; ++k) add(k);
    ASSERT_EQ(tails_.tails().size(), 2U) << "structure has none";
    const TrackTail& parked = tails_.tails()[0];
    EXPECT_EQ(parked.id, 1);
    ASSERT_EQ(parked.points.size(), 5U);
    for (const Eigen::Vector3d& p : parked.points)
        EXPECT_NEAR((p - Eigen::Vector3d(26.0, 3.0, 0.75)).norm(), 0.0, 1e-9);
    const TrackTail& van = tails_.tails()[1];
    EXPECT_NEAR(van.points.back().x(), 18.0, 1e-9) << "it ends at the box";
    EXPECT_NEAR(van.points.front().x(), 16.0, 1e-9) << "2 m in .4 s";
}

TEST_F(Tails, BoxesAsOfWhenTheyWereSeenAreInTheFrameOfThatInstant) {
    for (int k = 0; k <= 4; ++k) add(k, true, k % 2 == 0 ? 0.0 : 0.05);
    for (const Eigen::Vector3d& p : tails_.tails()[0].points) EXPECT_NEAR(p.x(), 26.0, 1e-6);
}

TEST_F(Tails, ReachBackOnlySoFarAndNotBeyondAGapOrAJump) {
    for (int k = 0; k < 30; ++k) add(k, k != 25);
    EXPECT_EQ(tails_.tails()[0].points.size(), 11U) << "one second";
    EXPECT_EQ(tails_.tails()[1].points.size(), 4U) << "the van was gone in scan 25";
    add(3);
    EXPECT_TRUE(tails_.tails().empty()) << "another place of the recording";
}

TEST(TableOfTracks, TellsTheNearestFirst) {
    ShownScan scan;
    Obstacle far = track(12, 30.0, 0.0);
    far.track->moving = false;
    Obstacle fresh = track(13, 40.0, 0.0);
    fresh.track->age = 0.0;
    fresh.track->velocity.reset();
    Obstacle hidden = track(7, 10.0, 0.0);
    hidden.track->seen = false;
    Obstacle untracked = track(99, 5.0, 0.0);
    untracked.track.reset();
    scan.result.obstacles = {fresh, far, hidden, untracked};
    EXPECT_EQ(tracksText(scan, 10),
              "track class          m   m/s  age s    p\n"
              "    7 vehicle      8.0   5.0    2.5 0.90 hidden\n"
              "   12 vehicle     28.0   0.0    2.5 0.90 \n"
              "   13 vehicle     38.0     -    0.0 0.90 new");
    EXPECT_THAT(tracksText(scan, 1),
                AllOf(HasSubstr("    7 vehicle"), Not(HasSubstr("   12")), HasSubstr("and 2 more")));
    scan.result.obstacles = {untracked};
    EXPECT_THAT(tracksText(scan, 10), AllOf(StartsWith("track"), HasSubstr("no tracks")));
}

}  // namespace
}  // namespace lidar_obstacles
