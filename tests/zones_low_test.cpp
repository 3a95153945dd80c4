// SPDX-License-Identifier: BSD-3-Clause
// Zones and the ground: steps and drops occupy them, missing ground leaves them unknown; and what beams prove away.
#include <gtest/gtest.h>

#include "lidar_obstacles/zones.h"
#include "support/low_scenes.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// A robot with its sensor at 0.5 m that looks at worlds from where it is, and one zone ahead of it.
class LowRobot {
  public:
    explicit LowRobot(const ZoneRule& rule = {})
        : detector_(lookingLow()),
          zones_({{{"ahead", ZoneFrame::Vehicle, {{0.8, -0.5}, {3.2, -0.5}, {3.2, 0.5}, {0.8, 0.5}}, rule}}, {}, {}},
                 RegionParams{}) {
        sensor_.position.z() = 0.5;
        sensor_.noise = 0.02;
    }

    /// @param x  of the robot; the world stays.
    const ZoneReport& see(World world, double x = 0.0) {
        for (GroundStrip& strip : world.ground) strip.x_min -= x, strip.x_max -= x;
        for (OrientedBox& box : world.boxes) box.center.x() -= x;
        return see(castRays(world, sensor_).cloud, x);
    }
    const ZoneReport& see(PointCloud cloud, double x = 0.0) {
        cloud.timestamp = time_ += 0.1;
        StampedPose pose;
        pose.time = time_;
        pose.position.x() = x;
        detector_.addPose(pose);
        found = detector_.process(std::move(cloud));
        return zones_.update({found, detector_.trajectory(), nullptr, std::nullopt}).front();
    }
    const Sensor& sensor() const { return sensor_; }

    SequenceResult found;

  private:
    ObstacleDetector detector_;
    ZoneMonitor zones_;
    Sensor sensor_;
    double time_ = 1000.0;
};

World edgeAt(double x, double deep) {
    World world;
    world.ground = {{{0.0, 0.0}, 0.0, -kInfinity, x}, {{0.0, 0.0}, -deep, x, kInfinity}};
    return world;
}

World brickAt(double x, double height) {
    World world = flatWorld();
    world.boxes = {boxAt(x, 0.0, 20.0, {0.2, 0.2, height})};
    return world;
}

TEST(Zones, AreOccupiedByADropAhead) {
    LowRobot robot;
    const ZoneReport& r = robot.see(edgeAt(2.5, 0.5));
    EXPECT_EQ(r.state, ZoneState::Occupied);
    EXPECT_EQ(r.reason, ZoneReason::Drop);
    EXPECT_EQ(robot.see(edgeAt(6.5, 0.5)).state, ZoneState::Occupied) << "held for a while";
    LowRobot another;
    EXPECT_EQ(another.see(edgeAt(4.5, 0.5)).state, ZoneState::Free) << "it ends behind the zone";
}

TEST(Zones, AreOccupiedByStepsOfTheirHeight) {
    ZoneRule rule;
    rule.min_height = 0.08;
    EXPECT_EQ(LowRobot(rule).see(brickAt(1.8, 0.12)).reason, ZoneReason::Step);
    rule.min_height = 0.2;
    EXPECT_EQ(LowRobot(rule).see(brickAt(1.8, 0.12)).state, ZoneState::Free);
}

TEST(Zones, CountStepsAsStructure) {
    ZoneRule rule;
    rule.min_height = 0.08;
    rule.classes = {true, true, true, true, false};
    EXPECT_EQ(LowRobot(rule).see(brickAt(1.8, 0.12)).state, ZoneState::Free);
}

TEST(Zones, AreNeverFreeWhereGroundIsMissing) {
    ZoneRule rule;
    rule.object_height = 0.4;
    LowRobot robot(rule);
    const Scan flat = castRays(flatWorld(), robot.sensor());
    const Scan holed = without(flat, [&](std::int32_t i) {
        const Eigen::Vector3f& p = flat.cloud.xyz[static_cast<std::size_t>(i)];
        return p.x() > 2.0f && p.x() < 2.4f && std::abs(p.y()) < 0.4f;
    });
    EXPECT_EQ(robot.see(holed.cloud).state, ZoneState::Unknown);
    EXPECT_EQ(robot.see(holed.cloud).reason, ZoneReason::NoGround);
    LowRobot another(rule);
    EXPECT_EQ(another.see(flat.cloud).state, ZoneState::Free) << toString(another.see(flat.cloud).reason);
}

TEST(Zones, AreFreeUnderWhatHangsAboveTheRobot) {
    ZoneRule rule;
    rule.max_height = 1.2;
    const auto under = [&](double height) {
        World world = flatWorld();
        world.boxes = {boxAt(2.5, 0.0, 0.0, {0.1, 3.0, 0.15}), boxAt(12.0, 0.0, 0.0, {0.2, 20.0, 3.0})};
        world.boxes[0].center.z() = height + 0.075;
        return LowRobot(rule).see(world).state;
    };
    EXPECT_EQ(under(0.8), ZoneState::Occupied);
    EXPECT_EQ(under(0.95), ZoneState::Occupied);
    EXPECT_EQ(under(1.3), ZoneState::Free);
}

TEST(LowMemory, KeepsWhatNoRingMeetsUntilABeamPassesLow) {
    ZoneRule rule;
    rule.min_height = 0.08;
    rule.off_after = 0.0;
    LowRobot robot(rule);
    const World brick = brickAt(4.0, 0.12);
    double x = 2.1;
    int remembered = 0;
    for (; x < 3.0; x += 0.05) {  // from 1.9 m away to 1 m: rings meet it, or none does
        const ZoneReport& r = robot.see(brick, x);
        if (x > 2.25) {
            EXPECT_EQ(r.state, ZoneState::Occupied) << x;
        }
        for (const LowThing& thing : robot.found.detection.low) remembered += static_cast<int>(thing.age > 0.0);
    }
    EXPECT_GT(remembered, 0);
    for (int k = 0; k < 2; ++k) robot.see(flatWorld(), 2.2);  // taken away
    EXPECT_EQ(robot.see(flatWorld(), 2.2).state, ZoneState::Free);
}

TEST(Zones, AreNotOccupiedByABoxThatBeamsPassThrough) {
    LowRobot robot;
    robot.see(flatWorld());
    SequenceResult found = robot.found;
    Obstacle ghost;  // a track whose returns are far from the zone, and whose box reaches into it
    ghost.cls = ObstacleClass::Vehicle;
    ghost.box = boxAt(3.0, 2.0, 90.0, {4.5, 1.8, 1.5});
    ghost.num_points = 20;
    found.detection.obstacles.push_back(ghost);
    ZoneMonitor zones({{{"ahead", ZoneFrame::Vehicle, {{0.8, -0.5}, {3.2, -0.5}, {3.2, 0.5}, {0.8, 0.5}}, {}}}, {}, {}},
                      RegionParams{});
    World wall = flatWorld();
    const Trajectory nowhere;
    EXPECT_EQ(zones.update({found, nowhere, nullptr, std::nullopt}).front().state, ZoneState::Free);
    wall.boxes = {boxAt(0.7, 0.0, 0.0, {0.1, 3.0, 2.0})};  // behind it anything may stand
    LowRobot blind;
    blind.see(wall);
    found.cloud = blind.found.cloud;
    found.detection.ground = blind.found.detection.ground;
    found.detection.candidates.clear();
    ZoneMonitor others(zones.set(), RegionParams{});
    EXPECT_EQ(others.update({found, nowhere, nullptr, std::nullopt}).front().reason, ZoneReason::Box);
}

}  // namespace
}  // namespace lidar_obstacles
