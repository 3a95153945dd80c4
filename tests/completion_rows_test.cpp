// SPDX-License-Identifier: BSD-3-Clause
// Which axis of a box is the length, where sizes and beams do not tell: that of the row.
#include <gtest/gtest.h>

#include "lidar_obstacles/completion.h"
#include "support/hull_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

const CompletionParams kParams;

Obstacle vehicle(const OrientedBox& box) {
    Obstacle o;
    o.cls = ObstacleClass::Vehicle;
    o.heading_valid = true;
    o.box = box;
    return o;
}

/// A strip of a face, 1.2 m wide, 10 m ahead: of a front or of a side. No beam tells what stands beside it.
const OrientedBox kStrip = boxAt(10.0, 0.0, 90.0, {1.2, 0.1, 0.8});

/// Both sides of a car were seen: it is longer than a car is wide.
OrientedBox wholeCar(double x, double y, double yaw) { return boxAt(x, y, yaw, {4.3, 1.8, 1.5}); }

/// The first of these boxes, completed.
OrientedBox completed(const std::vector<OrientedBox>& boxes) {
    std::vector<Obstacle> obstacles;
    for (const OrientedBox& box : boxes) obstacles.push_back(vehicle(box));
    return completeBoxes(obstacles, PointCloud{}, GroundModel{}, kParams).at(0).box;
}

TEST(CompletionRows, AloneItIsASide) { EXPECT_LT(headingError(completed({kStrip}).yaw, M_PI / 2), 0.1); }

TEST(CompletionRows, ItStandsAsTheNextOfTheRow) {
    for (const double yaw : {0.0, 180.0, 10.0, -12.0}) {
        const OrientedBox box = completed({kStrip, wholeCar(12.0, 3.0, yaw)});
        EXPECT_LT(headingError(box.yaw, 0.0), 0.1) << yaw;
        EXPECT_NEAR(box.size.x(), kParams.box.car_length, 1e-9);
    }
    EXPECT_LT(headingError(completed({kStrip, wholeCar(10.0, 5.0, 90.0)}).yaw, M_PI / 2), 0.1);
}

TEST(CompletionRows, TheNearestOneTells) {
    EXPECT_LT(headingError(completed({kStrip, wholeCar(10.0, 8.0, 90.0), wholeCar(12.0, -3.0, 0.0)}).yaw, 0.0), 0.1);
}

TEST(CompletionRows, WhatIsFarOffOrAslantTellsNothing) {
    EXPECT_LT(headingError(completed({kStrip, wholeCar(12.0, 14.0, 0.0)}).yaw, M_PI / 2), 0.1);
    EXPECT_LT(headingError(completed({kStrip, wholeCar(12.0, 3.0, 40.0)}).yaw, M_PI / 2), 0.1);
}

TEST(CompletionRows, BehindAnAslantOneTheNextOneTells) {
    const std::vector<OrientedBox> boxes{kStrip, wholeCar(11.0, 3.0, 40.0), wholeCar(13.0, 6.0, 0.0)};
    EXPECT_LT(headingError(completed(boxes).yaw, 0.0), 0.1);
    EXPECT_LT(headingError(completed({boxes[0], boxes[2], boxes[1]}).yaw, 0.0), 0.1);
}

TEST(CompletionRows, WhatMayBeNoVehicleTellsNothing) {
    Obstacle strip = vehicle(kStrip), board = vehicle(wholeCar(12.0, 3.0, 0.0));
    board.cls = ObstacleClass::Unknown;
    board.probability[static_cast<std::size_t>(ObstacleClass::Vehicle)] = 0.4f;
    const Obstacle after = completeBoxes({strip, board}, PointCloud{}, GroundModel{}, kParams).at(0);
    EXPECT_LT(headingError(after.box.yaw, M_PI / 2), 0.1);
}

TEST(CompletionRows, ABoxThatIsTurnedKeepsItsFacesWhereTheyWere) {
    Obstacle strip = vehicle(kStrip);  // its left face, seen from the origin
    strip.faces = kLeft;
    const Obstacle after =
        completeBoxes({strip, vehicle(wholeCar(12.0, 3.0, 0.0))}, PointCloud{}, GroundModel{}, kParams).at(0);
    EXPECT_NEAR(std::cos(after.box.yaw), 1.0, 1e-6);
    EXPECT_EQ(after.faces, kBack);
    EXPECT_NEAR(after.seen_box.size.x(), kStrip.size.y(), 1e-9);
    EXPECT_NEAR(after.seen_box.size.y(), kStrip.size.x(), 1e-9);
}

TEST(CompletionRows, WhatIsOpenItselfTellsNothing) {
    EXPECT_LT(headingError(completed({kStrip, boxAt(12.0, 3.0, 0.0, {1.2, 0.1, 0.8})}).yaw, M_PI / 2), 0.1);
}

TEST(CompletionRows, ARearAsWideAsACarStaysOne) {
    const OrientedBox rear = boxAt(10.0, 0.0, 0.0, {0.1, 1.7, 0.8});
    EXPECT_LT(headingError(completed({rear, wholeCar(10.0, 5.0, 90.0)}).yaw, 0.0), 0.1);
}

TEST(CompletionRows, WhatIsTooLongForAWidthStaysALength) {
    EXPECT_LT(headingError(completed({wholeCar(10.0, 0.0, 90.0), wholeCar(12.0, 3.0, 0.0)}).yaw, M_PI / 2), 0.1);
}

}  // namespace
}  // namespace lidar_obstacles
