// SPDX-License-Identifier: BSD-3-Clause
// Boxes from convex hulls (Sec. IV): corners, faces, heights, and what has no heading.
#include "lidar_obstacles/hull_fit.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "lidar_obstacles/clustering.h"
#include "support/hull_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using Vec2 = Eigen::Vector2d;

constexpr double kCell = 0.05;  // GridParams::fine_resolution [m]
constexpr double kHalfDiagonal = 0.5 * kCell * 1.4142135623730951;

/// Turns an outline around the sensor.
std::vector<Vec2> turned(std::vector<Vec2> outline, double yaw_deg) {
    for (Vec2& p : outline) p = Eigen::Rotation2Dd(radians(yaw_deg)) * p;
    return outline;
}

std::vector<Vec2> joined(std::vector<Vec2> a, const std::vector<Vec2>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// The fit of a cluster with the given cells and one return 1 m above the ground in the middle of each.
Obstacle fitCells(const std::vector<Vec2>& cells, const std::vector<Vec2>& returns) {
    PointCloud cloud = cloudOf({});
    for (const Vec2& p : returns) cloud.xyz.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), 1.0f);
    const GroundModel ground = knownGround(cloud);
    Cluster cluster = clusterOf(allReturns(cloud), ground);
    for (const Vec2& c : cells) cluster.cells.push_back(c.cast<float>());
    return fitHullBox(cluster, cloud, ground, {});
}

void expectNoHeading(const Obstacle& o) {
    EXPECT_FALSE(o.heading_valid);
    EXPECT_EQ(o.rule, HeadingRule::None);
    EXPECT_EQ(o.heading_std, 0.0);
    EXPECT_TRUE(isFinite(o.box));
    EXPECT_GT(o.box.size.minCoeff(), 0.0);
    EXPECT_GE(o.box.size.x(), o.box.size.y());
}

// A rectangle's two sides as in hull_fit.h: A to the right, B nearest to the sensor, C to the left.
struct Corners {
    Vec2 a, b, c;
    std::vector<Vec2> outline() const { return joined(lineOf(b, a), lineOf(b, c)); }
    Vec2 d() const { return a + c - b; }
};

/// A corner at B with sides of 3 m (to A) and 2 m (to C), the first turned from the line of sight by `turn_deg`.
Corners cornerAt(const Vec2& b, double turn_deg) {
    const Vec2 away = Eigen::Rotation2Dd(radians(-turn_deg)) * b.normalized();
    return {b + 3.0 * away, b, b + 2.0 * Vec2(-away.y(), away.x())};
}

TEST(HullFit, TheCornersOfTwoSidesAreMarkedToTheCell) {
    for (const double bearing : {-170.0, -80.0, 10.0, 100.0})
        for (double turn = 20.0; turn <= 70.0; turn += 5.0) {
            const Corners corners = cornerAt(Eigen::Rotation2Dd(radians(bearing)) * Vec2(9.0, 0.0), turn);
            const Obstacle o = fitOutline(corners.outline());
            ASSERT_EQ(o.rule, HeadingRule::TwoSides) << turn;
            ASSERT_EQ(o.marks.size(), 4u);
            // Each mark is the centre of a cell on the sides. Which cell: of those next to the end of a side that
            // leaves the line it is measured from at an angle, the outermost; along the side that is open to 1.41 c /
            // sin. B is measured from AC, A and C from their lines of sight, which the sides leave at no less.
            const auto slip = [](double angle) { return kHalfDiagonal + std::sqrt(2.0) * kCell / std::sin(angle); };
            EXPECT_LE((o.marks[1] - corners.b).norm(), slip(std::atan2(2.0, 3.0))) << turn;
            const auto fromSight = [&](const Vec2& end) {
                const Vec2 side = (end - corners.b).normalized();
                return std::asin(std::abs(side.x() * end.y() - side.y() * end.x()) / end.norm());
            };
            EXPECT_LE((o.marks[0] - corners.a).norm(), slip(fromSight(corners.a))) << turn;
            EXPECT_LE((o.marks[2] - corners.c).norm(), slip(fromSight(corners.c))) << turn;
            EXPECT_LE((o.marks[3] - (o.marks[0] + o.marks[2] - o.marks[1])).norm(), 1e-9) << "D = A + C - B";
        }
}

TEST(HullFit, TheBoxOfTwoSidesHasTheFourthCornerThatNoReturnTold) {
    for (double turn = 20.0; turn <= 70.0; turn += 5.0) {
        const Corners corners = cornerAt({9.0, 1.5}, turn);
        const Obstacle o = fitOutline(corners.outline());
        double nearest = kInfinity;
        for (const Vec2& c : cornersOf(o.box)) nearest = std::min(nearest, (c - corners.d()).norm());
        // the box is that of the returns: its corners move by what the heading may be off, a cell over the longer side
        EXPECT_LE(nearest, kCell * std::sqrt(2.0)) << turn;
    }
}

TEST(HullFit, SizeAndCentreComeFromTheReturnsAndNotFromTheCells) {
    // 2 m behind returns, and cells shifted by 0.3 m: only the returns count
    const auto outline = lineOf({10.0, -1.0}, {10.0, 1.0});
    std::vector<Vec2> cells;
    for (const Eigen::Vector2f& c : cellsAt(outline, kCell)) cells.emplace_back(c.cast<double>() + Vec2(0.3, 0.0));
    const Obstacle o = fitCells(cells, outline);
    EXPECT_NEAR(o.box.size.head<2>().maxCoeff(), 2.0, 1e-3);
    EXPECT_NEAR(distanceTo(o.box, Vec2::Zero()), 10.0, 1e-3);
}

TEST(HullFit, TwoSidesAreSeenWhereBothDimensionsExceedTheThreshold) {
    const double limit = HullFitParams{}.two_sides;
    for (double yaw = -180.0; yaw < 180.0; yaw += 5.0) {
        // the width over the cells' centres is that of the outline to half a diagonal at either end
        const Corners below = {{10.0, -2.0}, {10.0, 2.0}, {10.0 + limit - 2.1 * kHalfDiagonal, 2.0}};
        const Corners above = {{10.0, -2.0}, {10.0, 2.0}, {10.0 + limit + 2.1 * kHalfDiagonal, 2.0}};
        // seen from the left of the front, so that its end's side is turned to the sensor
        const Vec2 sensor = Eigen::Rotation2Dd(radians(yaw)) * Vec2(4.0, 8.0);
        const Obstacle one = fitOutline(turned(below.outline(), yaw), {}, sensor);
        const Obstacle two = fitOutline(turned(above.outline(), yaw), {}, sensor);
        EXPECT_EQ(one.rule, HeadingRule::Line) << yaw;
        EXPECT_EQ(two.rule, HeadingRule::TwoSides) << yaw;
        EXPECT_LE(axisError(one.box.yaw, radians(yaw)), 2.0) << yaw;
        EXPECT_LE(axisError(two.box.yaw, radians(yaw)), 2.0) << yaw;
    }
}

TEST(HullFit, AFaceWithReturnsBehindItHasNoCornerTowardsTheSensor) {
    // a rear and the roof behind it: both dimensions are large, but nothing stands out from the line across the rear
    auto outline = lineOf({10.0, -0.9}, {10.0, 0.9});
    for (const double x : {10.5, 11.0, 11.5, 12.0}) outline = joined(outline, lineOf({x, -0.7}, {x, 0.7}));
    const Obstacle o = fitOutline(outline);
    EXPECT_EQ(o.rule, HeadingRule::Line);
    EXPECT_LE(headingError(o.box.yaw, 0.0), 1.6) << "atan(c / 1.8 m)";
}

TEST(HullFit, APersonHasNoHeading) {
    for (double yaw = -180.0; yaw < 180.0; yaw += 15.0) {
        const Corners corners = {{8.0, -0.25}, {8.0, 0.25}, {8.3, 0.25}};
        const Obstacle o = fitOutline(turned(corners.outline(), yaw));
        expectNoHeading(o);
        // drawn across the line of sight to one of its cells, at most 1.8 deg off: 0.5 m * sin 1.8 deg
        EXPECT_NEAR(distanceTo(o.box, Vec2::Zero()), 8.0, 0.016);
        EXPECT_TRUE(o.marks.empty());
        EXPECT_FALSE(o.hull.empty());
    }
    expectNoHeading(lookAt(personAt(9.0, -2.0), fewPlanes(8)).found);
    expectNoHeading(lookAt(personAt(9.0, -2.0), fewPlanes(1)).found);
}

TEST(HullFit, TheLimitOfAPersonIsHeldToACell) {
    const double limit = HullFitParams{}.person;
    for (double yaw = -180.0; yaw < 180.0; yaw += 5.0) {
        const auto wide = [&](double width) {
            return fitOutline(turned(lineOf({8.0, -0.5 * width}, {8.0, 0.5 * width}), yaw));
        };
        EXPECT_EQ(wide(limit - 2.1 * kHalfDiagonal).rule, HeadingRule::None) << yaw;
        EXPECT_EQ(wide(limit + 2.1 * kHalfDiagonal).rule, HeadingRule::Line) << yaw;
    }
}

TEST(HullFit, AWallIsALine) {
    for (double yaw = -30.0; yaw <= 30.0; yaw += 5.0) {
        const HullView view = lookAt(boxAt(0.0, 12.0, yaw, {20.0, 0.3, 2.0}), fewPlanes(8));
        EXPECT_EQ(view.found.rule, HeadingRule::Line) << yaw;
        EXPECT_LE(headingError(view.found.box.yaw, radians(yaw)), 0.2) << "atan(1.41 c / 20 m)";
    }
}

/// Two cars in one cluster around a point 14 m ahead, turned together: the second at (x, y, turn) from the first, which
/// lies across.
Obstacle fitTwoCars(double yaw, const Vec2& second, double turn_deg) {
    const Vec2 middle(14.0, 0.0);
    const Vec2 there = middle + Eigen::Rotation2Dd(radians(yaw)) * second;
    World world = flatWorld();
    world.boxes = {carAt(middle.x(), middle.y(), yaw + 90.0), carAt(there.x(), there.y(), yaw + turn_deg)};
    const Scan scan = castRays(world, fewPlanes(8));
    const GroundModel ground = knownGround(scan);
    const auto candidates = cropToRegion(scan.cloud, ground, RegionParams{});
    const OccupancyGrid grid = buildFineGrid(scan.cloud, candidates, ground, {});
    auto points = scan.returnsOn(0);
    const auto others = scan.returnsOn(1);
    points.insert(points.end(), others.begin(), others.end());
    const Cluster both = addCells({clusterOf(points, ground)}, scan.cloud, ground, grid)[0];
    const Obstacle o = fitHullBox(both, scan.cloud, ground, {});
    EXPECT_TRUE(isFinite(o.box));
    for (const std::int32_t i : o.points)
        EXPECT_LE(distanceTo(o.box, scan.cloud.xyz[i].head<2>().cast<double>()), BoxParams{}.face_distance) << yaw;
    return o;
}

TEST(HullFit, TwoCarsThatTouchInAnLHaveTheirCommonAxes) {
    // the second stands behind the left end of the first, its length away from the sensor: their outer sides make one
    // corner towards the sensor
    for (double yaw = 15.0; yaw <= 60.0; yaw += 5.0) {
        const Obstacle o = fitTwoCars(-yaw, {0.9 + 2.25, -1.35}, 0.0);
        EXPECT_TRUE(o.heading_valid) << yaw;
        EXPECT_EQ(o.rule, HeadingRule::TwoSides) << yaw;
        EXPECT_LE(axisError(o.box.yaw, radians(-yaw)), 0.9) << yaw << ": atan(1.41 c / 4.5 m)";
    }
}

// The front of the second, the corner between the two and the end of the first make a triangle without a right angle at
// B, whose mean direction is that of neither car.
TEST(HullFit, TwoCarsThatTouchInAnLOpenToTheSensorHaveTheirCommonAxes) {
    for (double yaw = -20.0; yaw <= 85.0; yaw += 5.0) {
        const Obstacle o = fitTwoCars(yaw, {-3.15, -1.35}, 0.0);  // before the right end of the first
        EXPECT_LE(axisError(o.box.yaw, radians(yaw)), 2.0) << yaw;
    }
}

TEST(HullFit, WithoutCellsThereIsABoxWithoutAHeading) {
    const Obstacle o = fitCells({}, lineOf({10.0, -1.0}, {10.0, 1.0}));
    expectNoHeading(o);
    EXPECT_TRUE(o.hull.empty());
    EXPECT_TRUE(o.marks.empty());
    EXPECT_NEAR(o.box.size.x(), 2.0, 1e-3);
}

TEST(HullFit, OneCellHasNoHeading) {
    const Obstacle o = fitCells({{10.025, 2.025}}, {{10.0, 2.0}, {10.01, 2.01}});
    expectNoHeading(o);
    EXPECT_EQ(o.hull.size(), 1u);
    EXPECT_LE(distanceTo(o.box, {10.0, 2.0}), 0.01);
}

TEST(HullFit, CellsOnOneSpotHaveNoHeading) {
    expectNoHeading(fitCells(std::vector<Vec2>(12, {10.025, 2.025}), std::vector<Vec2>(12, {10.0, 2.0})));
}

TEST(HullFit, TwoCellsFarApartGiveFiniteNumbers) {
    const Obstacle o = fitCells({{10.025, -1.025}, {10.025, 1.025}}, {{10.0, -1.0}, {10.0, 1.0}});
    EXPECT_TRUE(isFinite(o.box));
    EXPECT_FALSE(o.heading_valid) << "two cells are no line";
}

TEST(HullFit, CellsAroundTheSensorGiveFiniteNumbers) {
    std::vector<Vec2> ring;
    for (int k = 0; k < 60; ++k) ring.emplace_back(1.5 * std::cos(0.105 * k), 1.5 * std::sin(0.105 * k));
    ring.emplace_back(0.0, 0.0);
    const Obstacle o = fitCells(ring, ring);
    EXPECT_TRUE(isFinite(o.box));
    for (const Vec2& m : o.marks) EXPECT_TRUE(m.allFinite());
}

TEST(HullFit, AClusterWithoutReturnsIsRefused) {
    EXPECT_THROW(fitHullBox(Cluster{}, PointCloud{}, GroundModel{}, {}), std::invalid_argument);
    EXPECT_TRUE(fitHullBoxes(PointCloud{}, {}, GroundModel{}, {}).empty());
}

TEST(HullFit, TheHullHoldsAllCellsInTheVehiclesFrame) {
    const HullView view = lookAt(carAt(9.0, -3.0, 30.0), fewPlanes(8));
    const std::vector<Vec2>& hull = view.found.hull;
    ASSERT_GE(hull.size(), 3u);
    double sense = 0.0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
        const Vec2 edge = hull[(k + 1) % hull.size()] - hull[k];
        for (const Eigen::Vector2f& c : view.cluster.cells) {
            const Vec2 to_cell = c.cast<double>() - hull[k];
            const double side = edge.x() * to_cell.y() - edge.y() * to_cell.x();
            if (std::abs(side) < 1e-5) continue;
            if (sense == 0.0) sense = side > 0.0 ? 1.0 : -1.0;
            ASSERT_GT(sense * side, 0.0) << "a cell outside the hull";
        }
    }
}

TEST(HullFit, TheMarksOfALineAreItsEnds) {
    const Obstacle o = fitOutline(lineOf({10.02, -1.5}, {10.02, 1.5}));
    ASSERT_EQ(o.rule, HeadingRule::Line);
    ASSERT_EQ(o.marks.size(), 2u);
    const double first = std::min(o.marks[0].y(), o.marks[1].y());
    const double last = std::max(o.marks[0].y(), o.marks[1].y());
    EXPECT_NEAR(first, -1.5, kCell);
    EXPECT_NEAR(last, 1.5, kCell);
    EXPECT_NEAR(o.marks[0].x(), 10.02, kCell);
}

}  // namespace
}  // namespace lidar_obstacles
