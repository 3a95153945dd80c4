// SPDX-License-Identifier: BSD-3-Clause
// The scans of several sensors as one cloud: each return keeps its own ray.
#include "lidar_obstacles/joined_cloud.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lidar_obstacles/beams.h"
#include "lidar_obstacles/deskew.h"
#include "lidar_obstacles/pipelines.h"
#include "support/size_model.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

const Eigen::Vector3d kFront{1.0, 0.0, 1.8}, kRear{-1.0, 0.0, 1.0};

Scan castFrom(const World& world, const Eigen::Vector3d& position) {
    Sensor sensor;
    sensor.position = position;
    return castRays(world, sensor);
}

TEST(JoinedCloud, OneCloudAloneStaysWhatItIs) {
    const PointCloud cloud = castFrom(street(), kFront).cloud;
    const PointCloud joined = joinedCloud({cloud});
    EXPECT_EQ(joined.xyz, cloud.xyz);
    EXPECT_EQ(joined.view.index, cloud.view.index);
    EXPECT_TRUE(joined.sensors.empty());
    EXPECT_TRUE(joinedCloud({}).empty());
}

TEST(JoinedCloud, EachReturnKeepsWhereItsRayStarts) {
    const PointCloud front = castFrom(street(), kFront).cloud, rear = castFrom(street(), kRear).cloud;
    const PointCloud joined = joinedCloud({front, rear});
    ASSERT_EQ(joined.size(), front.size() + rear.size());
    EXPECT_NO_THROW(validate(joined));
    const auto last_of_front = static_cast<std::int32_t>(front.size()) - 1;
    EXPECT_EQ(joined.originOf(last_of_front), front.sensor_origin);
    EXPECT_EQ(joined.originOf(last_of_front + 1), rear.sensor_origin);
    EXPECT_EQ(joined.view.rings, 32);
    EXPECT_EQ(joined.firstRing(15), 0);
    EXPECT_EQ(joined.endRing(15), 16);
    EXPECT_EQ(joined.firstRing(16), 16);
    EXPECT_EQ(joined.originOfRing(16), rear.sensor_origin);
}

TEST(JoinedCloud, NeighboursAreOfTheSameSensor) {
    const PointCloud front = castFrom(street(), kFront).cloud;
    const PointCloud joined = joinedCloud({front, castFrom(street(), kRear).cloud});
    const Beams alone(front), beams(joined);
    const auto size = static_cast<std::int32_t>(front.size());
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(joined.size()); ++i) {
        const std::int32_t next = beams.beside(i, 1);
        if (next >= 0) {
            EXPECT_EQ(next < size, i < size);
        }
    }
    for (std::int32_t i = 0; i < size; ++i) EXPECT_EQ(beams.range(i), alone.range(i));
    EXPECT_TRUE(std::isinf(beams.stepUp(15))) << "above the highest ring of the first is nothing of the second";
    EXPECT_TRUE(std::isinf(beams.stepDown(16)));
    EXPECT_NEAR(beams.stepUp(20), radians(2.0), 1e-3);
}

TEST(JoinedCloud, RingsCountUpwardsAlsoUpsideDown) {
    const PointCloud rear = castFrom(street(), kRear).cloud;
    const PointCloud upright = joinedCloud({castFrom(street(), kFront).cloud, rear});
    const PointCloud hanging = joinedCloud({castFrom(street(), kFront).cloud, upsideDown(rear)});
    EXPECT_EQ(hanging.ring, upright.ring);
    EXPECT_EQ(hanging.view.column_of, upright.view.column_of);
    EXPECT_EQ(hanging.sensors[1].up, Eigen::Vector3f::UnitZ());
}

TEST(JoinedCloud, TimesCountFromTheFirst) {
    PointCloud front = castFrom(street(), kFront).cloud, rear = castFrom(street(), kRear).cloud;
    front.timestamp = 100.0;
    front.time_offset.assign(front.size(), 0.01f);
    rear.timestamp = 99.96;
    const PointCloud joined = joinedCloud({front, rear});
    EXPECT_EQ(joined.timestamp, 100.0);
    EXPECT_FLOAT_EQ(joined.time_offset.front(), 0.01f);
    EXPECT_FLOAT_EQ(joined.time_offset.back(), -0.04f) << "all of it as of its timestamp";
}

TEST(JoinedCloud, WhatTheVehicleMovedMeanwhileIsUndone) {
    PointCloud front = castFrom(street(), kFront).cloud, rear = front;
    front.timestamp = 100.0;
    rear.timestamp = 100.05;
    Trajectory trajectory{EgoParams{}};
    for (const double time : {99.9, 100.0, 100.1, 100.2}) {
        StampedPose pose;
        pose.time = time;
        pose.position.x() = 10.0 * (time - 100.0);
        trajectory.add(pose);
    }
    const Deskewed straight = deskew(joinedCloud({front, rear}), trajectory);
    ASSERT_EQ(straight.how, Deskewing::Done);
    EXPECT_LT((straight.cloud.xyz.front() - front.xyz.front()).norm(), 3e-3f);
    const Eigen::Vector3f moved = straight.cloud.xyz.back() - rear.xyz.back();
    EXPECT_LT((moved - Eigen::Vector3f(0.5f, 0.0f, 0.0f)).norm(), 3e-3f);
    EXPECT_LT((straight.cloud.sensors[1].origin - rear.sensor_origin - moved).norm(), 3e-3f);
}

TEST(JoinedCloud, SensorsThatDoNotShareAllReturnsAreRefused) {
    PointCloud joined = joinedCloud({castFrom(street(), kFront).cloud, castFrom(street(), kRear).cloud});
    --joined.sensors.back().end;
    EXPECT_THROW(validate(joined), std::invalid_argument);
    ++joined.sensors.back().end;
    --joined.sensors.front().end_ring;
    EXPECT_THROW(validate(joined), std::invalid_argument);
}

TEST(JoinedCloud, ACarThatTwoSensorsSeeIsOneBox) {
    World world = flatWorld();
    world.boxes = {carAt(10.0, 1.0, 20.0), personAt(6.0, -4.0)};
    const PointCloud joined = joinedCloud({castFrom(world, kFront).cloud, upsideDown(castFrom(world, kRear).cloud)});
    const DetectionResult found = detect(joined, bySize());
    EXPECT_EQ(found.ground.evidence, GroundEvidence::Good);
    ASSERT_EQ(found.obstacles.size(), 2u);
    EXPECT_EQ(found.obstacles[0].cls, ObstacleClass::Pedestrian);
    EXPECT_EQ(found.obstacles[1].cls, ObstacleClass::Vehicle);
    EXPECT_LT((found.obstacles[1].box.center - world.boxes[0].center).head<2>().norm(), 0.3);
    EXPECT_LT(std::abs(normalizeAngle(2.0 * (found.obstacles[1].box.yaw - radians(20.0)))), radians(6.0));
}

TEST(JoinedCloud, ASensorUpsideDownAloneFindsWhatItFindsUpright) {
    const PointCloud upright = castFrom(street(), kFront).cloud;
    const auto as_it_is = detect(upright, bySize()).obstacles,
               hanging = detect(upsideDown(upright), bySize()).obstacles;
    ASSERT_EQ(hanging.size(), as_it_is.size());
    for (std::size_t k = 0; k < hanging.size(); ++k) {
        EXPECT_EQ(hanging[k].cls, as_it_is[k].cls);
        EXPECT_EQ(hanging[k].num_points, as_it_is[k].num_points);
    }
}

TEST(JoinedCloud, WhatOneSensorCannotSeeTheOtherShows) {
    World world = flatWorld();  // a wall that only the sensor ahead sees past
    world.boxes = {boxAt(0.0, 4.0, 0.0, {0.3, 6.0, 3.0}), personAt(5.0, 4.5), personAt(-5.0, 4.5)};
    const Scan front = castFrom(world, {1.5, 0.0, 1.2}), rear = castFrom(world, {-1.5, 0.0, 1.2});
    const auto people = [](const PointCloud& cloud) {
        const auto obstacles = detect(cloud, bySize()).obstacles;
        return std::count_if(obstacles.begin(), obstacles.end(),
                             [](const Obstacle& o) { return o.cls == ObstacleClass::Pedestrian; });
    };
    EXPECT_EQ(people(front.cloud), 1);
    EXPECT_EQ(people(rear.cloud), 1);
    EXPECT_EQ(people(joinedCloud({front.cloud, rear.cloud})), 2);
}

}  // namespace
}  // namespace lidar_obstacles
