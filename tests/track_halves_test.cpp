// SPDX-License-Identifier: BSD-3-Clause
// A lorry and its trailer that are followed as two are expected as one as well.
#include "sequence/track_halves.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lidar_obstacles {
namespace {

const Eigen::Vector2d kAlike(8.0, 0.0);  // velocity

ExpectedObject surely(ObstacleClass cls, const OrientedBox& box) {
    ExpectedObject o;
    o.box = box;
    o.std = 0.1;
    o.classes.fill(0.01f);
    o.classes[static_cast<std::size_t>(cls)] = 0.96f;
    return o;
}

ExpectedObject vehicle(const Eigen::Vector3d& center, const Eigen::Vector3d& size, double yaw = 0.0) {
    return surely(ObstacleClass::Vehicle, {center, size, yaw});
}

/// 8.4 m, then a drawbar of 1.5 m.
const ExpectedObject kLorry = vehicle({-6.6, 3.4, 1.8}, {8.4, 2.6, 3.6});
const ExpectedObject kTrailer = vehicle({3.2, 3.3, 1.8}, {8.2, 2.4, 3.4});

std::vector<ExpectedObject> withWholes(std::vector<ExpectedObject> objects, double faster = 0.0) {
    std::vector<Eigen::Vector2d> velocities(objects.size(), kAlike);
    velocities[0].x() += faster;
    addWholes(objects, velocities);
    return objects;
}

TEST(AddWholes, ALorryAndItsTrailerMayBeOne) {
    for (const bool turned_around : {false, true}) {
        const auto all = withWholes(turned_around ? std::vector{kTrailer, kLorry} : std::vector{kLorry, kTrailer});
        ASSERT_EQ(all.size(), 3u);
        const ExpectedObject& whole = all[2];
        EXPECT_EQ(whole.followed, 2);
        EXPECT_NEAR(whole.box.size.x(), 18.1, 1e-9);
        EXPECT_NEAR(whole.box.size.y(), 2.6, 1e-9);
        EXPECT_NEAR(whole.box.center.x(), -1.75, 1e-9);
        EXPECT_NEAR(whole.box.center.y(), 3.4, 1e-9);
        EXPECT_EQ(all[0].followed, 1);
        EXPECT_EQ(all[1].followed, 1);
    }
}

TEST(AddWholes, AlsoWhereTheyAreAslantAndTheHeadingIsReversed) {
    const double yaw = 0.7;
    const Eigen::Vector3d along(std::cos(yaw), std::sin(yaw), 0.0), lorry(12.0, 5.0, 1.8);
    const auto all =
        withWholes({vehicle(lorry, {8.0, 2.5, 3.6}, yaw), vehicle(lorry + 9.0 * along, {8.0, 2.5, 3.6}, yaw - M_PI)});
    ASSERT_EQ(all.size(), 3u);
    EXPECT_NEAR(all[2].box.size.x(), 17.0, 1e-6);
    EXPECT_NEAR(all[2].box.size.y(), 2.5, 1e-6);
    EXPECT_TRUE(all[2].box.center.isApprox(lorry + 4.5 * along, 1e-6));
}

TEST(AddWholes, CarsInARowStayCars) {
    const ExpectedObject behind = vehicle({0.0, 3.0, 0.75}, {4.2, 1.8, 1.5});
    const ExpectedObject ahead = vehicle({5.0, 3.0, 0.75}, {4.2, 1.8, 1.5});
    EXPECT_EQ(withWholes({behind, ahead}).size(), 2u);
}

TEST(AddWholes, LorriesApartAreTwo) {
    ExpectedObject other = kTrailer;
    other.box.center.x() += 1.0;  // 2.5 m apart
    EXPECT_EQ(withWholes({kLorry, other}).size(), 2u);
    other.box.center = kLorry.box.center + Eigen::Vector3d(0.0, 3.0, 0.0);  // beside it
    EXPECT_EQ(withWholes({kLorry, other}).size(), 2u);
}

TEST(AddWholes, WhatGoesAtAnotherSpeedIsAnother) { EXPECT_EQ(withWholes({kLorry, kTrailer}, 3.0).size(), 2u); }

TEST(AddWholes, WhatIsHardlyAVehicleHasNoHalves) {
    ExpectedObject bush = surely(ObstacleClass::Structure, kTrailer.box);
    EXPECT_EQ(withWholes({kLorry, bush}).size(), 2u);
    bush.classes.fill(0.05f);
    bush.classes[static_cast<std::size_t>(ObstacleClass::Vehicle)] = 0.7f;
    EXPECT_EQ(withWholes({kLorry, bush}).size(), 2u);
}

TEST(AddWholes, NobodyIsTakenForADrawbar) {
    const ExpectedObject person = surely(ObstacleClass::Pedestrian, {{-1.6, 3.4, 0.9}, {0.5, 0.5, 1.8}, 0.0});
    EXPECT_EQ(withWholes({kLorry, kTrailer, person}).size(), 3u);
}

TEST(AddWholes, OfNothingThereIsNone) {
    std::vector<ExpectedObject> none;
    addWholes(none, {});
    EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace lidar_obstacles
