// SPDX-License-Identifier: BSD-3-Clause
// What stands is not told to move by a view that changes, by one ring alone, by the errors of boxes; and it turns when
// it proves to be wider than vehicles of its height are.
#include <gtest/gtest.h>

#include "support/track_scene.h"

namespace lidar_obstacles::test {
namespace {

/// What is told, scan by scan, of a parked car whose hit line climbs its bonnet while the vehicle drives up to it.
/// @param climb  of the line per scan [m]
std::vector<TrackState> climbedBonnet(int rings, double climb) {
    Drive drive;
    drive.detector.face_std = 0.0;
    std::vector<TrackState> told;
    for (int n = 0; n < 12; ++n) {
        const Body line{ObstacleClass::Vehicle, {0.3, 1.6, 0.5}, {30.0 + climb * n, 3.0, 0.0}};
        drive.scan({}, {0.8 * n, 0.0, 0.0});
        drive.input.boxes = {drive.detector.see(line, {0.8 * n, 0.0, 0.0}, drive.time)};
        drive.input.boxes[0].num_rings = rings;
        drive.input.boxes[0].num_points = 10;
        drive.input.time = drive.time += 1e-3;
        told.push_back(rowOfBox(drive.tracker.update(drive.input), 0).state);
    }
    return told;
}

TEST(TrackMotion, TheLineOfOneRingThatClimbsABonnetIsSlowToBecomeAVelocity) {
    const TrackState one = climbedBonnet(1, 0.2).back(), three = climbedBonnet(3, 0.2).back();
    ASSERT_TRUE(one.velocity && three.velocity);
    EXPECT_TRUE(three.moving);
    EXPECT_FALSE(one.moving);
    EXPECT_LT(one.velocity->norm(), 0.5 * three.velocity->norm());
}

TEST(TrackMotion, NothingIsToldMovingThatTheErrorOfItsSpeedExplains) {
    int doubted = 0;
    for (const double climb : {0.05, 0.1, 0.15, 0.2})
        for (const int rings : {1, 2, 3}) {
            for (const TrackState& s : climbedBonnet(rings, climb)) {
                if (!s.velocity) continue;
                const bool explained = s.velocity->norm() <= 2.0 * s.velocity_std.norm();
                EXPECT_FALSE(s.moving && explained) << climb << " m a scan, " << rings << " rings, age " << s.age;
                doubted += explained && s.velocity->norm() > 0.3 ? 1 : 0;
            }
        }
    EXPECT_GT(doubted, 0) << "no line seemed to move: nothing was tried";
}

TEST(TrackMotion, WhatCreepsSlowerThanBoxesErrIsNotToldMoving) {
    Drive drive;
    drive.detector.face_std = 0.0;
    drive.detector.guess_std = 0.0;
    for (int n = 0; n < 60; ++n) {
        const TrackedBox& r = rowOfBox(drive.scan({carAt({12.0 + 0.02 * n, 4.0, 0.0})}), 0);
        EXPECT_FALSE(r.state.moving) << "scan " << n;
    }
}

TEST(TrackMotion, ASideThatWasTakenForAFrontIsALengthOnceMoreOfItIsSeen) {
    Drive drive;
    drive.detector.guess_std = 0.0;
    for (const double seen : {1.5, 2.2, 2.9, 3.6, 4.3, 4.3, 4.3})  // from behind another one, its depth never
        drive.scan({{ObstacleClass::Vehicle, {1.5, seen, 1.5}, {15.0, 5.0, M_PI / 2}}});
    const TrackedBox& row = rowOfBox(drive.scan({carAt({15.0, 5.0, 0.0})}), 0);
    ASSERT_EQ(row.id, 0) << "another track";
    EXPECT_NEAR(std::sin(row.box.yaw), 0.0, 0.05);
    EXPECT_NEAR(row.box.size.x(), 4.3, 0.3);
    EXPECT_LT(row.box.size.y(), 2.2);
}

TEST(TrackMotion, ALengthThatWasSeenStaysOneWhateverIsSeenAfterwards) {
    Drive drive;
    drive.detector.guess_std = 0.0;
    for (int n = 0; n < 5; ++n) drive.scan({carAt({15.0, 5.0, 0.0})});
    for (int n = 0; n < 30; ++n) {  // told as a front each time
        const Body side{ObstacleClass::Vehicle, {1.5, 4.3, 1.5}, {15.0, 5.0, M_PI / 2}};
        const TrackedBox& row = rowOfBox(drive.scan({side}), 0);
        EXPECT_NEAR(std::sin(row.box.yaw), 0.0, 0.05) << "scan " << n;
        EXPECT_NEAR(row.box.size.x(), 4.3, 0.3) << "scan " << n;
    }
}

}  // namespace
}  // namespace lidar_obstacles::test
