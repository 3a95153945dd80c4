// SPDX-License-Identifier: BSD-3-Clause
// In which frame tracks are told and asked for, and what nobody knows without the vehicle's poses.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

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

/// A vehicle that drives straight on; lasers see what they see some time after the stamp, in the frame of that instant.
struct StraightDrive {
    explicit StraightDrive(double vehicle_speed) : speed(vehicle_speed) {
        drive.input.pose_at = [this](double time) { return test::poseAt(placeAt(time)); };
    }
    Place placeAt(double time) const { return {speed * (time - 1000.0), 0.0, 0.0}; }
    SeenBox see(const Body& body, double late) {
        return drive.detector.see(body, placeAt(drive.time + late), drive.time + late);
    }
    const std::vector<TrackedBox>& take(std::vector<SeenBox> boxes) {
        drive.input.time = drive.time;
        drive.input.T_world_vehicle = test::poseAt(placeAt(drive.time));
        drive.input.boxes = std::move(boxes);
        drive.time += 0.1;
        return drive.tracker.update(drive.input);
    }

    double speed;  ///< [m/s]
    Drive drive;
};

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

/// Whether a lorry straight ahead takes its rear, and not the board 1.3 m within it that one scan shows as well.
/// @param late  when the laser sees that scan's boxes, after the stamp; those of the others .09 s after it [s]
bool takesItsRear(double vehicle_speed, double lorry_speed, double late) {
    StraightDrive straight(vehicle_speed);
    const Eigen::Vector3d size(8.0, 2.5, 3.0);
    const auto lorryAt = [&](double time) {
        return Body{ObstacleClass::Vehicle, size, {40.0 + lorry_speed * (time - 1000.0), 0.0, 0.0}};
    };
    int id = -1;
    for (int n = 0; n < 12; ++n)
        id = rowOfBox(straight.take({straight.see(lorryAt(straight.drive.time + 0.09), 0.09)}), 0).id;
    SeenBox rear = straight.see(lorryAt(straight.drive.time + late), late);
    rear.box.center.x() += 0.5 * (0.3 - rear.box.size.x());
    rear.box.size = {0.3, size.y(), size.z()};
    rear.seen_box = rear.box;
    rear.faces = 0;
    rear.heading_valid = false;
    rear.heading_std = 0.0;
    SeenBox within = rear;
    within.box.center.x() += 1.3;
    within.seen_box = within.box;
    for (const TrackedBox& row : straight.take({rear, within}))
        if (row.id == id) return row.source == 0;
    return false;
}

TEST(Tracker, ATrackAndABoxAreComparedFromWhereTheLaserWasWhenItSawTheBox) {
    // as of the stamp, the rear is 1.3 m farther away than as of the instant in which it was seen
    EXPECT_TRUE(takesItsRear(14.0, 0.0, 0.09));
    EXPECT_TRUE(takesItsRear(0.0, 14.0, 0.0)) << "last seen at the end of a turn, now at its beginning";
    EXPECT_TRUE(takesItsRear(14.0, 14.0, 0.0)) << "and with the vehicle behind it";
}

TEST(Tracker, WhatStandsBehindATrackDoesNotHideIt) {
    // no cloud: boxes alone tell what is hidden, from where the laser was when it looked there
    StraightDrive straight(20.0);
    const Body person = personAt({90.0, 2.0, 0.0}), car = carAt({92.55, 2.0, 0.0});  // its rear .1 m behind the person
    for (int n = 0; n < 18; ++n) straight.take({straight.see(car, 0.09), straight.see(person, 0.09)});
    std::size_t rows = 0;
    for (int n = 0; n < 15; ++n) rows = straight.take({straight.see(car, 0.09)}).size();
    EXPECT_EQ(rows, 1u) << "who has gone is told";
}

}  // namespace
}  // namespace lidar_obstacles
