// SPDX-License-Identifier: BSD-3-Clause
// What must be found in a recording of one's own robot. Here: eight simulated scans of a street.
#include <gmock/gmock.h>
#include <lidar_obstacles/testing/matchers.h>
#include <lidar_obstacles/testing/rawlog.h>

using namespace lidar_obstacles::testing;

TEST(Street, TheUnloadingTruckStandsRightOfTheLane) {
    const RawlogResult scans = detectRawlog(RAWLOG);
    EXPECT_THAT(scans.front(), HasObstacle(Vehicle).near(10.1, -3.6, 1).heading(7_deg, 5));
}

TEST(Street, ABusComesTowardsUsInTheOtherLane) {
    // Little of its side is seen: its middle is known within 3 m only.
    EXPECT_THAT(detectRawlog(RAWLOG).at(3), HasObstacle(Vehicle).near(14.5, 3.6, 3).heading(180_deg, 5));
}

TEST(Street, NothingIsInTheWay) {
    for (const ScanObstacles& scan : detectRawlog(RAWLOG)) EXPECT_THAT(scan, EmptyCorridor(2, 6, 0.9));
}
