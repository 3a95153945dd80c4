// SPDX-License-Identifier: BSD-3-Clause
// What a class says of a box: headings of people, and which side of what has none is the longer one.
#include "lidar_obstacles/classification.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lidar_obstacles {
namespace {

/// An obstacle whose box was fitted with a heading of 0.3 rad.
Obstacle fitted(ObstacleClass cls, double length, double width) {
    Obstacle o;
    o.cls = cls;
    o.box.size = {length, width, 1.7};
    o.box.yaw = 0.3;
    o.heading_valid = true;
    o.heading_std = 0.1;
    o.rule = HeadingRule::Plane;
    return o;
}

void expectHeadingKept(Obstacle o) {
    const Obstacle before = o;
    applyClass(o);
    EXPECT_TRUE(o.heading_valid);
    EXPECT_GE(o.heading_std, before.heading_std);
    EXPECT_EQ(o.rule, before.rule);
    EXPECT_EQ(o.box.yaw, before.box.yaw);
    EXPECT_EQ(o.box.size, before.box.size);
}

void expectNoHeading(Obstacle o) {
    applyClass(o);
    EXPECT_FALSE(o.heading_valid);
    EXPECT_EQ(o.heading_std, 0.0);
    EXPECT_EQ(o.rule, HeadingRule::None);
    EXPECT_GE(o.box.size.x(), o.box.size.y());
}

TEST(ApplyClass, VehiclesAndWhatIsUnknownKeepTheirHeading) {
    expectHeadingKept(fitted(ObstacleClass::Vehicle, 4.5, 1.8));
    expectHeadingKept(fitted(ObstacleClass::Vehicle, 1.2, 1.8));  // the rear alone was seen
    expectHeadingKept(fitted(ObstacleClass::Unknown, 1.2, 0.8));
}

TEST(ApplyClass, PeopleAndStructureHaveNone) {
    expectNoHeading(fitted(ObstacleClass::Pedestrian, 0.6, 0.5));
    expectNoHeading(fitted(ObstacleClass::Structure, 3.0, 0.5));
}

TEST(ApplyClass, ARiderSeenAlongTheBicycleKeepsTheHeading) {
    expectHeadingKept(fitted(ObstacleClass::Cyclist, 1.7, 0.6));
    expectNoHeading(fitted(ObstacleClass::Cyclist, 0.7, 0.6));  // seen from behind
    expectNoHeading(fitted(ObstacleClass::Cyclist, 1.1, 0.9));  // as wide as long
}

TEST(ApplyClass, ARidersHeadingIsAsSureAsTheDiagonalOfHisBoxAllows) {
    Obstacle rider = fitted(ObstacleClass::Cyclist, 1.7, 0.6), car = fitted(ObstacleClass::Vehicle, 4.5, 1.8);
    const double fit = car.heading_std;
    applyClass(rider);
    applyClass(car);
    EXPECT_NEAR(rider.heading_std, std::hypot(fit, std::atan2(0.6, 1.7)), 1e-9);
    EXPECT_EQ(car.heading_std, fit);
}

TEST(ApplyClass, WithoutAHeadingTheLongerSideIsTheLengthAndTheBoxStaysWhereItIs) {
    Obstacle person = fitted(ObstacleClass::Pedestrian, 0.4, 0.7);
    applyClass(person);
    EXPECT_EQ(person.box.size, Eigen::Vector3d(0.7, 0.4, 1.7));
    EXPECT_NEAR(std::remainder(person.box.yaw - 0.3, M_PI), M_PI / 2, 1e-9) << "a quarter turn";
    EXPECT_GE(person.box.yaw, -M_PI);
    EXPECT_LT(person.box.yaw, M_PI);
}

TEST(ApplyClass, ATurnedBoxKeepsItsFacesWhereTheyWere) {
    Obstacle rider = fitted(ObstacleClass::Cyclist, 0.4, 1.8);
    rider.faces = kBack;
    applyClass(rider);
    EXPECT_NEAR(rider.box.yaw, 0.3 + M_PI / 2, 1e-9);
    EXPECT_EQ(rider.faces, kLeft);
}

TEST(ApplyClass, ARiderWhoseBoxWasTakenForTheWrongSideIsTurned) {
    Obstacle rider = fitted(ObstacleClass::Cyclist, 0.5, 1.7);
    applyClass(rider);
    EXPECT_TRUE(rider.heading_valid);
    EXPECT_EQ(rider.box.size, Eigen::Vector3d(1.7, 0.5, 1.7));
    EXPECT_NEAR(std::abs(std::remainder(rider.box.yaw - 0.3, M_PI)), M_PI / 2, 1e-9);
}

/// A road user of 20 returns and 0.7 of its class, of which 2 x 0.8 m are seen; its box was completed to 4 m.
Obstacle roadUser(ObstacleClass cls) {
    Obstacle o;
    o.cls = cls;
    o.probability[static_cast<std::size_t>(cls)] = 0.7f;
    o.num_points = 20;
    o.seen_box.size = {2.0, 0.8, 1.5};
    o.box.size = {4.0, 1.7, 1.5};
    return o;
}

constexpr ObstacleClass kRoadUsers[] = {ObstacleClass::Vehicle, ObstacleClass::Pedestrian, ObstacleClass::Cyclist};

TEST(ToldClass, WithTheDefaultsItIsTheClass) {
    for (const ObstacleClass cls : kRoadUsers) {
        Obstacle o = roadUser(cls);
        o.num_points = 1;
        o.probability.fill(0.0f);
        o.seen_box.size.x() = 40.0;
        EXPECT_EQ(toldClass(o, {}), cls);
    }
}

/// Expects that a limit of a class says what is called that class, and nothing of the others.
template <class Number>
void expectOnlyOf(ObstacleClass cls, Number GateParams::* limit, Number kept, Number unknown) {
    GateParams params;
    for (const ObstacleClass other : kRoadUsers) {
        params.*limit = kept;
        EXPECT_EQ(toldClass(roadUser(other), params), other);
        params.*limit = unknown;
        EXPECT_EQ(toldClass(roadUser(other), params), other == cls ? ObstacleClass::Unknown : other);
    }
}

TEST(ToldClass, FewerReturnsThanTheMinimumOfItsClassAreUnknown) {
    expectOnlyOf(ObstacleClass::Vehicle, &GateParams::min_points_vehicle, 20, 21);
    expectOnlyOf(ObstacleClass::Pedestrian, &GateParams::min_points_pedestrian, 20, 21);
    expectOnlyOf(ObstacleClass::Cyclist, &GateParams::min_points_cyclist, 20, 21);
}

TEST(ToldClass, MoreThanTheLengthOfItsClassIsUnknownAsFarAsItIsSeen) {
    expectOnlyOf(ObstacleClass::Vehicle, &GateParams::max_length_vehicle, 2.0, 1.9);
    expectOnlyOf(ObstacleClass::Pedestrian, &GateParams::max_length_pedestrian, 2.0, 1.9);
    expectOnlyOf(ObstacleClass::Cyclist, &GateParams::max_length_cyclist, 2.0, 1.9);
}

TEST(ToldClass, ARoadUserLessProbableThanTheMinimumIsUnknown) {
    GateParams params;
    for (const ObstacleClass cls : kRoadUsers) {
        params.min_probability = 0.7;
        EXPECT_EQ(toldClass(roadUser(cls), params), cls);
        params.min_probability = 0.71;
        EXPECT_EQ(toldClass(roadUser(cls), params), ObstacleClass::Unknown);
    }
}

TEST(ToldClass, StructureAndWhatIsUnknownStay) {
    GateParams params;
    params.min_points_vehicle = params.min_points_pedestrian = params.min_points_cyclist = 100;
    params.min_probability = 1.0;
    for (const ObstacleClass cls : {ObstacleClass::Structure, ObstacleClass::Unknown})
        EXPECT_EQ(toldClass(roadUser(cls), params), cls);
}

TEST(ToldClass, OfWhatATrackPredictsOnlyTheProbabilityCounts) {
    GateParams params;
    params.min_points_vehicle = 100;
    params.max_length_vehicle = 1.0;
    Obstacle hidden = roadUser(ObstacleClass::Vehicle);
    hidden.track.emplace().seen = false;
    EXPECT_EQ(toldClass(hidden, params), ObstacleClass::Vehicle);
    hidden.track->seen = true;
    EXPECT_EQ(toldClass(hidden, params), ObstacleClass::Unknown);
    hidden.track->seen = false;
    params.min_probability = 0.8;
    EXPECT_EQ(toldClass(hidden, params), ObstacleClass::Unknown);
}

}  // namespace
}  // namespace lidar_obstacles
