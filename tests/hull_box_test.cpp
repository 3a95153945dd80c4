// SPDX-License-Identifier: BSD-3-Clause
// What a box from a convex hull tells of its obstacle: faces, planes, heights.
#include <gtest/gtest.h>

#include "objects/gates.h"
#include "support/hull_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// The faces in the names of the true box: those of a box found the other way round (its half turn is not seen)
/// swapped, and those of one whose length and width are exchanged turned by a quarter.
std::uint8_t inTruthsNames(const Obstacle& found, const OrientedBox& truth) {
    constexpr Face kRound[4] = {kFront, kLeft, kBack, kRight};  // counter-clockwise
    const int quarters = static_cast<int>(std::lround((found.box.yaw - truth.yaw) / (M_PI / 2)));
    std::uint8_t faces = 0;
    for (int k = 0; k < 4; ++k)
        if ((found.faces & kRound[k]) != 0) faces |= kRound[((k + quarters) % 4 + 4) % 4];
    return faces;
}

TEST(HullBox, FacesAreThoseTurnedToTheSensor) {
    for (const Eigen::Vector2d& place : {Eigen::Vector2d(10, 1), {8, -4}, {14, 6}, {-9, 2}})
        for (double yaw = -90.0; yaw < 90.0; yaw += 5.0) {
            const OrientedBox car = carAt(place.x(), place.y(), yaw);
            SCOPED_TRACE(std::to_string(place.x()) + ", " + std::to_string(place.y()) + " " + std::to_string(yaw));
            const Obstacle found = lookAt(car, fewPlanes(8)).found;
            const std::uint8_t faces = inTruthsNames(found, car);
            std::uint8_t turned = 0;
            for (const SeenFace& f : seenFaces(car)) {
                turned |= f.face;
                // 8 columns on each of several planes: three returns and more, also without those at the corners
                const bool sure = f.angle > 8.0 * radians(0.2);
                EXPECT_TRUE(!sure || (faces & f.face) != 0) << facesText(f.face);
            }
            EXPECT_EQ(faces & ~turned, 0) << facesText(faces) << " of " << facesText(turned);
        }
}

TEST(HullBox, TheRearAheadIsTheBackAndTheFlankTheSide) {
    EXPECT_EQ(facesText(lookAt(carAt(10.0, 0.0, 0.0), fewPlanes(8)).found.faces), "B");
    EXPECT_EQ(facesText(lookAt(carAt(0.0, 6.0, 0.0), fewPlanes(8)).found.faces), "R");
    EXPECT_EQ(facesText(lookAt(carAt(0.0, -6.0, 0.0), fewPlanes(8)).found.faces), "L");
    EXPECT_EQ(facesText(lookAt(carAt(-10.0, 0.0, 0.0), fewPlanes(8)).found.faces), "F");
    EXPECT_EQ(facesText(lookAt(carAt(9.0, 4.0, 0.0), fewPlanes(8)).found.faces), "BR");
}

/// The fit of the object behind the gates, which measure how high it may be.
Obstacle gatedFit(const OrientedBox& box, const Sensor& sensor) {
    const HullView view = lookAt(box, sensor);
    Hypothesis group;
    group.points = view.cluster.points;
    group.whole = 1.0f;
    group.chosen = true;
    SurfaceTops topOf(view.scan.cloud, view.ground);
    Clusters gated = sortGroups({group}, topOf, Beams(view.scan.cloud), GateParams{});
    if (gated.accepted.size() != 1) {
        ADD_FAILURE() << "rejected as " << toString(gated.rejected.at(0).reason);
        return {};
    }
    gated.accepted[0].cells = view.cluster.cells;
    return fitHullBox(gated.accepted[0], view.scan.cloud, view.ground, {});
}

TEST(HullBox, TheTrueHeightLiesBetweenWhatWasHitAndWhereTheNextPlanePassed) {
    for (const int planes : {8, 4, 1})
        for (double x = 8.0; x <= 16.0; x += 0.5)
            for (const double height : {1.5, 2.0}) {
                const OrientedBox car = boxAt(x, 1.0, 20.0, {4.5, 1.8, height});
                if (lookAt(car, fewPlanes(planes)).cluster.top < GateParams{}.min_top) continue;  // may be low: no car
                const Obstacle o = gatedFit(car, fewPlanes(planes));
                EXPECT_LE(o.box.size.z(), height + 1e-4) << planes << " planes at " << x;
                EXPECT_GE(o.max_height, height - 1e-4) << planes << " planes at " << x;
                EXPECT_GE(o.max_height, o.box.size.z());
            }
}

TEST(HullBox, WhatTheHighestPlaneHitMayBeOfAnyHeight) {
    EXPECT_EQ(gatedFit(carAt(9.0, 1.0, 20.0), fewPlanes(1)).max_height, kInfinity);
}

TEST(HullBox, ThePlaneThatPassedAboveItLimitsItsHeight) {
    // 16 m away planes 0.56 m apart: one at 1.24 m, the next at 1.8 m
    const Obstacle o = gatedFit(carAt(18.25, 0.0, 0.0), Sensor{});
    EXPECT_NEAR(o.box.size.z(), 1.8 - 16.0 * std::tan(radians(1.0)), 0.35);
    EXPECT_LT(o.max_height, 2.4);
}

TEST(HullBox, AHeightOfOnePlaneIsThatOfItsReturns) {
    const OrientedBox car = carAt(10.0, 0.0, 0.0);
    const Obstacle o = lookAt(car, fewPlanes(1)).found;
    EXPECT_EQ(o.num_rings, 1);
    // 7.75 m away, at its ends 7.80 m
    EXPECT_NEAR(o.box.size.z(), 1.8 - 7.75 * std::tan(radians(5.0)), 0.01);
    EXPECT_NEAR(o.box.center.z() - 0.5 * o.box.size.z(), 0.0, 1e-6) << "it stands on the ground all the same";
}

TEST(HullBox, CountsReturnsAndPlanes) {
    const HullView view = lookAt(carAt(10.0, 2.0, 10.0), fewPlanes(8));
    EXPECT_EQ(view.found.points, view.cluster.points);
    EXPECT_EQ(view.found.num_points, static_cast<int>(view.cluster.points.size()));
    // z = 0 .. 1.5 at 7.7 m lies between -13.2 deg and -2.2 deg: -11, -7 and -3
    EXPECT_EQ(view.found.num_rings, 3);
}

TEST(HullBox, BothSeenSidesOfACarTellItsSize) {
    const Obstacle o = lookAt(carAt(8.0, 6.0, 0.0), fewPlanes(8)).found;
    // each end may lie a column beyond the last return: 10 m * 0.2 deg = 3.5 cm, along a side seen at 37 deg 6 cm
    EXPECT_NEAR(o.box.size.x(), 4.5, 0.12);
    EXPECT_NEAR(o.box.size.y(), 1.8, 0.08);
}

TEST(HullBox, TheNearestPointOfTheBoxIsThatOfTheCar) {
    for (double yaw = -90.0; yaw < 90.0; yaw += 5.0) {
        const OrientedBox car = carAt(10.0, 2.0, yaw);
        const double truth = distanceTo(car, Eigen::Vector2d::Zero());
        // a corner may lie half a column from the last return; the heading's error turns the side about its middle
        const double turned = 0.5 * 4.5 * std::sin(std::atan(1.42 * 0.05 / 4.5));
        EXPECT_NEAR(distanceTo(lookAt(car, fewPlanes(8)).found.box, Eigen::Vector2d::Zero()), truth, 0.02 + turned)
            << yaw;
    }
}

}  // namespace
}  // namespace lidar_obstacles
