// SPDX-License-Identifier: BSD-3-Clause
// In which frame tracks are told and asked for, and what nobody knows without the vehicle's poses.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "lidar_obstacles/tracking.h"
#include "support/synthetic_scene.h"
#include "support/track_scene.h"

namespace lidar_obstacles {
namespace {

using test::Body;
using test::carAt;
using test::Drive;
using test::personAt;
using test::Place;
using test::rowOfBox;

TEST(Tracker, WithoutPosesWhatComesNearerMayStillBeStructure) {
    for (const bool poses_known : {false, true}) {
        Drive drive;
        drive.input.poses_known = poses_known;
        ObstacleClass last = ObstacleClass::Unknown;
        for (int n = 0; n < 15; ++n) {
            SeenBox bin = drive.detector.see(carAt({20.0 - 1.0 * n, 4.0, 0.0}), {}, drive.time);
            bin.classes[static_cast<std::size_t>(ObstacleClass::Vehicle)] = 0.3f;
            bin.classes[static_cast<std::size_t>(ObstacleClass::Structure)] = 0.55f;
            drive.input.time = drive.time;
            drive.input.boxes = {bin};
            last = rowOfBox(drive.tracker.update(drive.input), 0).cls;
            drive.time += 0.1;
        }
        EXPECT_EQ(last, poses_known ? ObstacleClass::Vehicle : ObstacleClass::Structure);
    }
}

TEST(Tracker, AFirstBoxIsToldInTheFrameThatIsAskedFor) {
    // seen .08 s into the scan, by when the vehicle has gone on by 1.2 m and turned
    Drive drive;
    const Body car = carAt({20.0, 5.0, 0.3});
    const Place at_stamp{0.0, 0.0, 0.0}, later{1.2, 0.1, 0.05};
    drive.input.time = drive.time;
    drive.input.boxes = {drive.detector.see(car, later, drive.time + 0.08)};
    drive.input.told_for = drive.time;
    drive.input.T_world_told = test::poseAt(at_stamp);
    const TrackedBox& r = rowOfBox(drive.tracker.update(drive.input), 0);
    EXPECT_NEAR(r.box.center.x(), 20.0, 0.6);
    EXPECT_NEAR(r.box.center.y(), 5.0, 0.3);
    EXPECT_NEAR(r.box.yaw, 0.3, 0.05);
}

TEST(TrackedObstacles, FacesAreThoseOfTheTracksAxes) {
    Obstacle o;  // an oncoming car: its box points away from the vehicle, as boxes do, its track to it
    o.box = {{15.0, 0.0, 0.75}, {4.0, 1.8, 1.5}, 0.1};
    o.seen_box = {{13.2, 0.0, 0.75}, {0.4, 1.8, 1.5}, 0.1};
    o.faces = kBack | kLeft;
    o.heading_valid = true;
    o.heading_std = 0.05;
    TrackedBox row;
    row.source = 0;
    row.box = o.box;
    row.heading_valid = true;
    for (const auto& [yaw, faces] : {std::pair{0.1 + M_PI, kFront | kRight}, {0.1 + M_PI_2, kLeft | kFront}}) {
        row.box.yaw = normalizeAngle(yaw);
        std::vector<Obstacle> boxes{o};
        const Obstacle told = trackedObstacles({row}, boxes).at(0);
        EXPECT_EQ(told.faces, faces);
        EXPECT_NEAR(std::abs(normalizeAngle(told.seen_box.yaw - yaw)), 0.0, 1e-9);
        EXPECT_EQ(told.heading_std, 0.05);
    }
    row.heading_valid = false;
    std::vector<Obstacle> boxes{o};
    EXPECT_EQ(trackedObstacles({row}, boxes).at(0).heading_std, 0.0);
}

TEST(Tracker, ExistenceIsAskedOfTheFrameInWhichItsBeamsAreTold) {
    // a person whom no box fits any more stands in a cloud that is told, as lasers see it, .09 s after the stamp
    const Body person = personAt({9.0, 4.0, 0.0});
    const auto scansSeen = [&](bool with_poses_at) {
        Drive drive;
        const auto egoAt = [](double time) { return test::poseAt({14.0 * (time - 1002.0), 0.0, 0.0}); };
        const auto step = [&](bool seen) {
            drive.time += 0.1;
            drive.input.time = drive.time;
            drive.input.T_world_vehicle = egoAt(drive.time);
            const double x = 14.0 * (drive.time + 0.09 - 1002.0);
            drive.input.boxes.clear();
            if (seen) drive.input.boxes.push_back(drive.detector.see(person, {x, 0.0, 0.0}, drive.time + 0.09));
            test::World world;
            world.ground.push_back({});
            world.boxes.push_back({{40.0 - x, 0.0, 2.0}, {0.5, 60.0, 4.0}, 0.0});
            world.boxes.push_back({{9.0 - x, 4.0, 0.875}, {0.6, 0.6, 1.75}, 0.0});
            const test::Scan scan = castRays(world, test::Sensor{});
            drive.input.cloud = &scan.cloud;
            drive.tracker.update(drive.input);
            drive.input.cloud = nullptr;
        };
        if (with_poses_at) drive.input.pose_at = egoAt;
        for (int n = 0; n < 18; ++n) step(true);
        int scans = 0;
        while (drive.tracker.size() > 0 && scans < 8) {
            step(false);
            ++scans;
        }
        return scans;
    };
    EXPECT_EQ(scansSeen(true), 8);
    EXPECT_LT(scansSeen(false), 8);
}

}  // namespace
}  // namespace lidar_obstacles
