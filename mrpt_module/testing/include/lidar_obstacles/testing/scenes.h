// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Small worlds for unit tests that need neither a file nor a scenario of their own. There where the library was built
/// with the simulation.
///
///     const RawlogResult scans = detectScenario(carAhead(12));
///     EXPECT_THAT(scans.back(), HasObstacle(Vehicle).near(12, 0, .5));
///
/// Each is the text of a scenario for detectScenario(), to print, to keep as a file, to change
/// (datasets/scenarios/README.md has the keys). A VLP-16 is 1.8 m above the origin of the vehicle, on a straight, level
/// road along x; ten scans, in a second. Unless it says otherwise the vehicle stands, and so places are in its frame: x
/// ahead, y to the left [m], of the middle of a thing.
#pragma once

#include <string>

namespace lidar_obstacles::testing {

/// The road, and nothing on it or beside it: what is found here was invented.
std::string emptyRoad();

/// A car stands straight ahead and is seen from behind.
/// @param x  of its middle, 5 to 50 m
std::string carAhead(double x = 12.0);

/// A person stands in front of a wall that runs along the road from x = 0 to x = 30, 5 m to the right of the vehicle.
/// @param gap  between the middle of the person, at x = 10, and the wall, 0.3 to 3 m
std::string personBesideWall(double gap = 1.0);

/// Four cars are parked along the right kerb, at x = 6, 12, 18 and 24, y = -4; the lane beside them is free.
std::string parkedCars();

/// Houses stand on both sides of the road up to a crossing street at x = 20; a car is half out of that street, from the
/// right, at (20, -3), and a person waits at its corner, at (15, -4).
std::string streetCorner();

/// A person crosses the road from the right to the left at 1.5 m/s, 12 m ahead; at y = 0 in the middle of the second.
std::string personCrossing();

/// The vehicle drives at 8 m/s behind a van, which is 15 m ahead at the end of the second, and does so at `speed`.
/// @param speed  0 to 20 m/s
std::string vanAhead(double speed = 10.0);

}  // namespace lidar_obstacles::testing
