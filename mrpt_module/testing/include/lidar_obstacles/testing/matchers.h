// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Matchers for GoogleMock: what must stand somewhere, and what must be free. They take ScanObstacles, DetectionResult,
/// SequenceResult or std::vector<Obstacle>, and where they fail they list what came nearest.
///
///     EXPECT_THAT(scan, HasObstacle(Vehicle).near(12, 3, .5).heading(90_deg, 5));
///     EXPECT_THAT(scan, EmptyCorridor(2, 10, 1.2));
///
/// This namespace and GoogleTest's have the same last name: where both are open, write GoogleTest's with a
/// leading `::`.
#pragma once

#include <cmath>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/testing/find_obstacle.h"

namespace lidar_obstacles {

/// For GoogleTest's messages: testing::describe().
void PrintTo(const Obstacle& obstacle, std::ostream* os);

namespace testing {

inline constexpr ObstacleClass Vehicle = ObstacleClass::Vehicle;
inline constexpr ObstacleClass Pedestrian = ObstacleClass::Pedestrian;
inline constexpr ObstacleClass Cyclist = ObstacleClass::Cyclist;
inline constexpr ObstacleClass Structure = ObstacleClass::Structure;
inline constexpr ObstacleClass Unknown = ObstacleClass::Unknown;

/// Degrees as radians: 90_deg.
constexpr double operator""_deg(long double degrees) { return static_cast<double>(degrees) * M_PI / 180.0; }
constexpr double operator""_deg(unsigned long long degrees) { return static_cast<double>(degrees) * 1.0_deg; }

/// Is there an obstacle of this class for which all that was asked holds? Vehicle frame, metres, seconds.
/// An object is for one thread at a time.
/// @throws std::invalid_argument, from every member, if a tolerance is not a positive number.
class HasObstacle {
  public:
    using is_gtest_matcher = void;

    explicit HasObstacle(ObstacleClass cls) : cls_(cls) {}

    /// Its centre is within `tolerance` of (x, y) [m], seen from above.
    HasObstacle& near(double x, double y, double tolerance);
    /// It has a heading, and that is `yaw` [rad, from +x to the left] within `tolerance_deg`, modulo 180 degrees.
    HasObstacle& heading(double yaw, double tolerance_deg);
    /// Its front is known and points to `yaw` [rad], within `tolerance_deg`; needs a track that has moved.
    HasObstacle& facing(double yaw, double tolerance_deg);
    /// Its speed over ground is known and within `tolerance` of `metres_per_second`; needs tracks and poses.
    HasObstacle& speed(double metres_per_second, double tolerance);
    /// Its class is at least this probable, 0 .. 1.
    HasObstacle& probability(double at_least);

    /// True where one obstacle fits. Else the explanation lists the nearest misses, and what is wrong with each.
    bool matches(const std::vector<Obstacle>& obstacles, std::ostream* explanation) const;
    template <typename Result>
    bool MatchAndExplain(const Result& result, std::ostream* explanation) const {
        return matches(obstaclesOf(result), explanation);
    }
    void DescribeTo(std::ostream* os) const;
    void DescribeNegationTo(std::ostream* os) const;

  private:
    struct Place {
        double x, y, tolerance;
    };
    struct Angle {
        double yaw, tolerance_deg;
    };
    struct Speed {
        double metres_per_second, tolerance;
    };
    std::vector<std::string> faultsOf(const Obstacle& obstacle) const;
    void addAngleFaults(const Obstacle& obstacle, std::vector<std::string>& faults) const;
    void addTrackFaults(const Obstacle& obstacle, std::vector<std::string>& faults) const;
    double distanceTo(const Obstacle& obstacle) const;
    std::string wanted() const;

    ObstacleClass cls_;
    std::optional<Place> place_;
    std::optional<Angle> heading_, facing_;
    std::optional<Speed> speed_;
    double min_probability_ = 0.0;
};

/// Is there no box, of any class, in the rectangle from `x_from` to `x_to` ahead and `half_width` to either side [m]?
/// Seen from above; a box that reaches in counts, and so does a track that is hidden at the moment.
/// An object is for one thread at a time.
class EmptyCorridor {
  public:
    using is_gtest_matcher = void;

    /// @throws std::invalid_argument if the corridor has no area.
    EmptyCorridor(double x_from, double x_to, double half_width);

    /// Else the explanation lists what stands in it, the nearest first.
    bool matches(const std::vector<Obstacle>& obstacles, std::ostream* explanation) const;
    template <typename Result>
    bool MatchAndExplain(const Result& result, std::ostream* explanation) const {
        return matches(obstaclesOf(result), explanation);
    }
    void DescribeTo(std::ostream* os) const;
    void DescribeNegationTo(std::ostream* os) const;

  private:
    bool holds(const OrientedBox& box) const;

    double x_from_, x_to_, half_width_;
};

}  // namespace testing
}  // namespace lidar_obstacles
