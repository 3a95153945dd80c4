// SPDX-License-Identifier: BSD-3-Clause
// What stands is not told to move: by a view that changes, by one ring alone, by the errors of boxes.
#include <gtest/gtest.h>

#include "support/track_scene.h"

namespace lidar_obstacles::test {
namespace {

/// What is told of a parked car whose hit line climbs its bonnet while the vehicle drives up to it.
TrackState climbedBonnet(int rings) {
    Drive drive;
    drive.detector.face_std = 0.0;
    TrackState last;
    for (int n = 0; n < 12; ++n) {
        const Body line{ObstacleClass::Vehicle, {0.3, 1.6, 0.5}, {30.0 + 0.2 * n, 3.0, 0.0}};
        drive.scan({}, {0.8 * n, 0.0, 0.0});
        drive.input.boxes = {drive.detector.see(line, {0.8 * n, 0.0, 0.0}, drive.time)};
        drive.input.boxes[0].num_rings = rings;
        drive.input.boxes[0].num_points = 10;
        drive.input.time = drive.time += 1e-3;
        last = rowOfBox(drive.tracker.update(drive.input), 0).state;
    }
    return last;
}

TEST(TrackMotion, TheLineOfOneRingThatClimbsABonnetIsSlowToBecomeAVelocity) {
    const TrackState one = climbedBonnet(1), three = climbedBonnet(3);
    ASSERT_TRUE(one.velocity && three.velocity);
    EXPECT_TRUE(three.moving);
    EXPECT_FALSE(one.moving);
    EXPECT_LT(one.velocity->norm(), 0.5 * three.velocity->norm());
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

}  // namespace
}  // namespace lidar_obstacles::test
