// SPDX-License-Identifier: BSD-3-Clause
// What the matchers accept, and what they say where they do not.
#include "lidar_obstacles/testing/matchers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "lidar_obstacles/testing/find_obstacle.h"

namespace lidar_obstacles::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Obstacle obstacleAt(double x, double y, ObstacleClass cls = Vehicle) {
    Obstacle o;
    o.cls = cls;
    o.probability[static_cast<std::size_t>(cls)] = 0.9F;
    o.box.center = {x, y, 0.8};
    o.box.size = {4.0, 2.0, 1.5};
    o.heading_valid = true;
    o.num_points = 50;
    return o;
}

/// What GoogleTest would print of a failure.
template <typename Matcher>
std::string explanationOf(const Matcher& matcher, const std::vector<Obstacle>& obstacles) {
    std::ostringstream text;
    EXPECT_FALSE(matcher.matches(obstacles, &text));
    return text.str();
}

TEST(HasObstacle, NearTakesWhatIsWithinTheTolerance) {
    const std::vector<Obstacle> scan{obstacleAt(12.3, 3.4)};
    EXPECT_THAT(scan, HasObstacle(Vehicle).near(12, 3, 0.51));
    EXPECT_THAT(scan, Not(HasObstacle(Vehicle).near(12, 3, 0.49)));
    EXPECT_THAT(scan, Not(HasObstacle(Pedestrian).near(12, 3, 0.51)));
    EXPECT_THAT(scan, HasObstacle(Vehicle)) << "anywhere";
}

TEST(HasObstacle, WhatIsNoNumberIsNowhere) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    Obstacle o = obstacleAt(kNan, 0);
    o.track = TrackState{};
    o.track->direction_known = true;
    o.track->velocity = Eigen::Vector2d(kNan, 0.0);
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).near(12, 3, 100)));
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).speed(5, 100)));
    EXPECT_THAT(std::vector{o}, Not(EmptyCorridor(1, 10, 1))) << "it may be there";
    EXPECT_FALSE(findObstacle({o}, Vehicle, 12, 3, 100));
    o = obstacleAt(12, 3);
    o.box.yaw = kNan;
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).heading(0_deg, 89)));
}

TEST(HasObstacle, HeadingHoldsModulo180Degrees) {
    Obstacle o = obstacleAt(10, 0);
    o.box.yaw = -88_deg;
    EXPECT_THAT(std::vector{o}, HasObstacle(Vehicle).heading(90_deg, 2.1));
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).heading(90_deg, 1.9)));
    o.heading_valid = false;
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).heading(90_deg, 2.1)));
}

TEST(HasObstacle, FacingNeedsAKnownFront) {
    Obstacle o = obstacleAt(10, 0);
    o.box.yaw = 179_deg;
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).facing(180_deg, 5)));
    o.track = TrackState{};
    o.track->direction_known = true;
    EXPECT_THAT(std::vector{o}, HasObstacle(Vehicle).facing(-180_deg, 5));
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).facing(0_deg, 5)));
}

TEST(HasObstacle, SpeedAndProbabilityCount) {
    Obstacle o = obstacleAt(10, 0);
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).speed(0, 1))) << "not known";
    o.track = TrackState{};
    o.track->velocity = Eigen::Vector2d(3, 4);
    EXPECT_THAT(std::vector{o}, HasObstacle(Vehicle).speed(5, 0.1).probability(0.8));
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).speed(6, 0.9)));
    EXPECT_THAT(std::vector{o}, Not(HasObstacle(Vehicle).probability(0.95)));
}

TEST(HasObstacle, TheMessageListsTheNearestMissesFirst) {
    const std::vector<Obstacle> scan{obstacleAt(40, 0), obstacleAt(13, 3), obstacleAt(12, 3, Pedestrian),
                                     obstacleAt(20, 3), obstacleAt(30, 3)};
    const std::string text = explanationOf(HasObstacle(Vehicle).near(12, 3, 0.5).heading(90_deg, 5), scan);
    EXPECT_THAT(text, AllOf(HasSubstr("is no vehicle, heading 90.0 deg off"), HasSubstr("1.00 m away"),
                            HasSubstr("at (20.0, 3.0)"), Not(HasSubstr("(30.0")), Not(HasSubstr("(40.0"))));
    EXPECT_LT(text.find("pedestrian 0 at (12.0, 3.0)"), text.find("vehicle 0 at (13.0, 3.0)"));
    EXPECT_EQ(explanationOf(HasObstacle(Vehicle), {}), "there is no obstacle at all");
}

TEST(HasObstacle, TheDescriptionSaysWhatWasAskedFor) {
    std::ostringstream text;
    HasObstacle(Cyclist).near(12, -3, 0.5).heading(90_deg, 5).speed(4, 1).DescribeTo(&text);
    EXPECT_EQ(text.str(),
              "has an obstacle: cyclist within 0.50 m of (12.0, -3.0), heading 90 deg within 5.0 deg, 4.0 m/s within "
              "1.0 m/s");
}

TEST(HasObstacle, ToleranceThatIsNoneIsAnError) {
    EXPECT_THROW(HasObstacle(Vehicle).near(1, 1, 0), std::invalid_argument);
    EXPECT_THROW(HasObstacle(Vehicle).heading(1, -1), std::invalid_argument);
    EXPECT_THROW(HasObstacle(Vehicle).probability(1.1), std::invalid_argument);
    EXPECT_THROW(findObstacle(std::vector<Obstacle>{}, Vehicle, 0, 0, std::nan("")), std::invalid_argument);
}

TEST(EmptyCorridor, ABoxThatReachesInCounts) {
    Obstacle o = obstacleAt(5, 2.2);  // its side is at y = 1.2
    EXPECT_THAT(std::vector{o}, EmptyCorridor(0, 10, 1.19));
    EXPECT_THAT(std::vector{o}, Not(EmptyCorridor(0, 10, 1.21)));
    o.box.yaw = 90_deg;  // now its end, at y = 0.2
    EXPECT_THAT(std::vector{o}, Not(EmptyCorridor(0, 10, 0.21)));
    EXPECT_THAT(std::vector{o}, EmptyCorridor(6.1, 10, 3)) << "it is 1 m deep on either side of x = 5";
}

TEST(EmptyCorridor, ATurnedBoxBesideItsCornerIsNotInIt) {
    Obstacle o = obstacleAt(11.9, 2.9);  // a bounding box of it reaches in, the box itself does not
    o.box.yaw = -45_deg;
    EXPECT_THAT(std::vector{o}, EmptyCorridor(0, 10, 1.0));
}

TEST(EmptyCorridor, TheMessageListsWhatStandsInIt) {
    const std::string text = explanationOf(EmptyCorridor(0, 20, 1), {obstacleAt(15, 0), obstacleAt(5, 0, Pedestrian)});
    EXPECT_THAT(text, HasSubstr("2 in it:\n    pedestrian 0 at (5.0, 0.0)"));
    EXPECT_THROW(EmptyCorridor(3, 3, 1), std::invalid_argument);
}

TEST(FindObstacle, GivesTheNearestOfItsClass) {
    DetectionResult result;
    result.obstacles = {obstacleAt(11, 0), obstacleAt(10.2, 0), obstacleAt(10, 0, Structure)};
    const auto found = findObstacle(result, Vehicle, 10, 0, 2);
    ASSERT_TRUE(found);
    EXPECT_DOUBLE_EQ(found->box.center.x(), 10.2);
    EXPECT_FALSE(findObstacle(result, Vehicle, 10, 0, 0.1));
}

TEST(Describe, TellsAnObstacleInOneLine) {
    Obstacle o = obstacleAt(12.04, -0.01);
    o.id = 7;
    o.box.yaw = 88_deg;
    EXPECT_EQ(describe(o), "vehicle 7 at (12.0, 0.0), 4.0 x 2.0 x 1.5 m, heading 88 deg, 50 returns");
    EXPECT_EQ(::testing::PrintToString(o), describe(o));
}

}  // namespace
}  // namespace lidar_obstacles::testing
