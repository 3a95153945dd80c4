// SPDX-License-Identifier: BSD-3-Clause
// The ready-made worlds hold what they say: it is found at its place, and nothing is where nothing stands.
#include "lidar_obstacles/testing/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "lidar_obstacles/testing/matchers.h"
#include "lidar_obstacles/testing/scenario.h"

namespace lidar_obstacles::testing {
namespace {

using ::testing::Not;
using ::testing::SizeIs;

TEST(Scenes, AllHaveTenScans) {
    for (const std::string& scene :
         {emptyRoad(), carAhead(), personBesideWall(), parkedCars(), streetCorner(), personCrossing(), vanAhead()})
        EXPECT_THAT(simulation::turnsOf(simulation::parseScenario(scene, "scene"), {}), SizeIs(10)) << scene;
}

TEST(Scenes, NothingIsFoundOnTheEmptyRoad) { EXPECT_THAT(detectScenario(emptyRoad()).back().obstacles, SizeIs(0)); }

TEST(Scenes, TheCarIsAsFarAheadAsAsked) {
    for (const double x : {6.0, 12.0, 20.0}) {
        const ScanObstacles scan = detectScenario(carAhead(x)).back();
        EXPECT_THAT(scan, HasObstacle(Vehicle).near(x, 0, 1.0).heading(0, 10).speed(0, 0.5));
        EXPECT_THAT(scan, EmptyCorridor(2, x - 3.0, 1.5));
    }
}

TEST(Scenes, ThePersonBesideTheWallIsNoPartOfIt) {
    const ScanObstacles scan = detectScenario(personBesideWall()).back();
    EXPECT_THAT(scan, HasObstacle(Pedestrian).near(10, -4, 0.5));
    EXPECT_THAT(scan, Not(HasObstacle(Vehicle)));
    EXPECT_THAT(detectScenario(personBesideWall(2)).back(), HasObstacle(Pedestrian).near(10, -3, 0.5));
}

TEST(Scenes, TheParkedCarsAreFourBoxesBesideAFreeLane) {
    const ScanObstacles scan = detectScenario(parkedCars()).back();
    for (const double x : {6.0, 12.0, 18.0, 24.0})
        EXPECT_THAT(scan, HasObstacle(Vehicle).near(x, -4, 1.5).heading(0, 10));
    EXPECT_THAT(scan, EmptyCorridor(2, 30, 1.5));
}

TEST(Scenes, TheCarAtTheCornerStandsAcross) {
    const ScanObstacles scan = detectScenario(streetCorner()).back();
    EXPECT_THAT(scan, HasObstacle(Vehicle).near(20, -3, 1.0).heading(90_deg, 10));
    EXPECT_THAT(scan, HasObstacle(Pedestrian).near(15, -4, 0.5));
    EXPECT_THAT(scan, EmptyCorridor(2, 17, 1.5));
}

TEST(Scenes, ThePersonThatCrossesHasItsSpeed) {
    EXPECT_THAT(detectScenario(personCrossing()).back(), HasObstacle(Pedestrian).near(12, 0.7, 0.5).speed(1.5, 0.7));
}

TEST(Scenes, TheVanHasTheSpeedThatWasAsked) {
    for (const double speed : {0.0, 10.0})
        EXPECT_THAT(detectScenario(vanAhead(speed)).back(), HasObstacle(Vehicle).near(15, 0, 1.0).speed(speed, 1));
}

TEST(Scenes, NumbersOutOfRangeAreErrorsOfTheCaller) {
    EXPECT_THROW(carAhead(4.9), std::invalid_argument);
    EXPECT_THROW(personBesideWall(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
    EXPECT_THROW(vanAhead(-1), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles::testing
