// SPDX-License-Identifier: BSD-3-Clause
// Headings from the cells of the fine grid (Sec. IV), held to what cells of 5 cm allow.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "support/hull_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr double kCell = 0.05;        // GridParams::fine_resolution [m]
constexpr double kColumn = 0.2;       // azimuth step of the sensor [deg]
constexpr double kManyColumns = 8.0;  // returns of one plane on a side that is seen without doubt

/// How far cells may turn a side of length L [deg]. A point of it lies within half a cell of its cell's centre along x
/// and along y: across the side, which runs at `yaw`, that is c / 2 (|cos| + |sin|), between c / 2 and 0.71 c. Both
/// ends moved so, to different sides, turn it by atan(c (|cos| + |sin|) / L): a degree for a car's side, two for its
/// rear.
double cellBound(double yaw, double length, double cell = kCell) {
    return degrees(std::atan(cell * (std::abs(std::cos(yaw)) + std::abs(std::sin(yaw))) / length));
}

std::string at(const OrientedBox& box, int planes) {
    return "box at " + std::to_string(box.center.x()) + ", " + std::to_string(box.center.y()) + " yaw " +
           std::to_string(degrees(box.yaw)) + " seen by " + std::to_string(planes) + " planes";
}

double columnsOn(const SeenFace& face) { return degrees(face.angle) / kColumn; }

/// The longest of the sides that returns are sure to lie on [m].
double longestSeen(const std::vector<SeenFace>& faces) {
    double longest = 0.0;
    for (const SeenFace& f : faces)
        if (columnsOn(f) >= kManyColumns) longest = std::max(longest, f.length);
    return longest;
}

/// Two sides, one, or nullopt where the second is a matter of a return or two.
std::optional<HeadingRule> ruleOf(const std::vector<SeenFace>& faces) {
    if (faces.size() == 1) return HeadingRule::Line;
    const double fewer = std::min(columnsOn(faces[0]), columnsOn(faces[1]));
    if (fewer >= kManyColumns) return HeadingRule::TwoSides;
    return std::nullopt;
}

/// The box in all directions at places around the sensor.
std::vector<OrientedBox> allPoses(const Eigen::Vector3d& size) {
    std::vector<OrientedBox> poses;
    for (const Eigen::Vector2d& place : {Eigen::Vector2d(10, 1), {8, -4}, {14, 6}, {1, 7}, {-9, 2}})
        for (double yaw = -90.0; yaw < 90.0; yaw += 5.0) poses.push_back(boxAt(place.x(), place.y(), yaw, size));
    return poses;
}

void expectHeading(const OrientedBox& box, int planes) {
    SCOPED_TRACE(at(box, planes));
    const Obstacle found = lookAt(box, fewPlanes(planes)).found;
    const auto faces = seenFaces(box);
    EXPECT_TRUE(found.heading_valid);
    EXPECT_LE(headingError(found.box.yaw, box.yaw), cellBound(box.yaw, longestSeen(faces)));
}

TEST(HullHeading, ACarIsFoundInEveryDirectionHoweverFewThePlanes) {
    for (const int planes : {8, 4, 1})
        for (const OrientedBox& car : allPoses({4.5, 1.8, 1.5})) expectHeading(car, planes);
}

TEST(HullHeading, TwoSidesOrALineAsTwoSidesAreSeenOrOne) {
    // higher than the sensor, so that no returns on the roof make the outline of one side thick
    for (const int planes : {8, 4, 1})
        for (const OrientedBox& van : allPoses({4.5, 1.8, 2.0})) {
            const std::optional<HeadingRule> rule = ruleOf(seenFaces(van));
            if (!rule) continue;
            SCOPED_TRACE(at(van, planes));
            EXPECT_STREQ(toString(lookAt(van, fewPlanes(planes)).found.rule), toString(*rule));
        }
}

TEST(HullHeading, ABusIsFoundInEveryDirection) {
    for (double yaw = -90.0; yaw < 90.0; yaw += 5.0)
        for (const Eigen::Vector2d& place : {Eigen::Vector2d(14, 1), {12, -8}, {2, 12}}) {
            const OrientedBox bus = boxAt(place.x(), place.y(), yaw, {11.0, 2.55, 3.0});
            SCOPED_TRACE(at(bus, 8));
            const Obstacle found = lookAt(bus, fewPlanes(8)).found;
            const double longest = longestSeen(seenFaces(bus));
            // a bus's rear alone is 2.55 m wide: a side as well as a rear, so that only the axes are asked for
            EXPECT_LE(axisError(found.box.yaw, bus.yaw), cellBound(bus.yaw, longest));
            const bool side_seen = longest > 5.0;
            EXPECT_LE(side_seen ? headingError(found.box.yaw, bus.yaw) : 0.0, 45.0);
        }
}

TEST(HullHeading, TheRearOfACarAheadIsNotItsSide) {
    for (const double x : {8.0, 12.0, 16.0}) {
        expectHeading(carAt(x, 0.0, 0.0), 4);
        expectHeading(carAt(x, 0.0, 90.0), 4);
        expectHeading(boxAt(x, 0.0, 0.0, {5.5, 2.0, 2.4}), 4);
    }
}

TEST(HullHeading, ASensorAwayFromTheOriginSeesTheSame) {
    // moved by whole cells, so that the cells are the same
    const Eigen::Vector3d shift(3.0, -2.5, 0.0);
    for (double yaw = -90.0; yaw < 90.0; yaw += 15.0) {
        Sensor sensor = fewPlanes(8);
        const Obstacle here = lookAt(carAt(9.0, 2.0, yaw), sensor).found;
        sensor.position += shift;
        const Obstacle there = lookAt(carAt(9.0 + shift.x(), 2.0 + shift.y(), yaw), sensor).found;
        EXPECT_EQ(there.rule, here.rule) << yaw;
        // a return on the border of two cells may fall into the other one
        EXPECT_LE(axisError(there.box.yaw, here.box.yaw), 0.1) << yaw;
        EXPECT_NEAR((there.box.center - here.box.center - shift).norm(), 0.0, 0.02) << yaw;
        ASSERT_EQ(there.marks.size(), here.marks.size());
        for (std::size_t k = 0; k < here.marks.size(); ++k)
            EXPECT_LE((there.marks[k] - here.marks[k] - shift.head<2>()).norm(), kCell * std::sqrt(2.0)) << yaw;
        ASSERT_FALSE(there.hull.empty());
        EXPECT_LE(distanceTo(there.box, there.hull[0]), 0.2) << "the hull is told in the vehicle's frame";
    }
}

TEST(HullHeading, ACloudWithoutRingsIsServedAsWell) {
    Sensor sensor = fewPlanes(8);
    sensor.rings = false;
    for (double yaw = -90.0; yaw < 90.0; yaw += 15.0) {
        const OrientedBox car = carAt(9.0, 2.0, yaw);
        const Obstacle found = lookAt(car, sensor).found;
        EXPECT_LE(headingError(found.box.yaw, car.yaw), cellBound(car.yaw, longestSeen(seenFaces(car)))) << yaw;
        EXPECT_EQ(found.num_rings, 0);
    }
}

/// Two sides of a rectangle around its corner nearest to the sensor: a = 4 m and b = 2 m long, turned by `yaw`, the
/// side that goes left from the corner being b.
std::vector<Eigen::Vector2d> twoSides(double yaw, double bend = 0.0, double a = 4.0, double b = 2.0) {
    const Eigen::Vector2d corner(8.05, 1.02);
    // the sides lie at 45 deg to either side of the line of sight, so that both are turned to the sensor
    const double middle = std::atan2(corner.y(), corner.x());
    const Eigen::Vector2d right(std::cos(middle + yaw - M_PI / 4), std::sin(middle + yaw - M_PI / 4));
    const Eigen::Vector2d left(std::cos(middle + yaw + M_PI / 4 + bend), std::sin(middle + yaw + M_PI / 4 + bend));
    std::vector<Eigen::Vector2d> outline = lineOf(corner, corner + a * right);
    for (const Eigen::Vector2d& p : lineOf(corner, corner + b * left)) outline.push_back(p);
    return outline;
}

/// Direction of the first side of twoSides.
double sideOf(double yaw) { return std::atan2(1.02, 8.05) + yaw - M_PI / 4; }

TEST(HullHeading, TheCornersAloneTellTwoSidesAsWellAsTheirCellsAllow) {
    DetectorParams params;
    params.hull_fit.refine = false;
    for (double yaw_deg = -40.0; yaw_deg <= 40.0; yaw_deg += 5.0) {
        const Obstacle o = fitOutline(twoSides(radians(yaw_deg)), params);
        EXPECT_EQ(o.rule, HeadingRule::TwoSides) << yaw_deg;
        // B may be a cell beside the corner: along the longer side, which the line AC leaves at atan(b / a), cells lie
        // as high above AC up to 1.41 c / sin(atan(b / a)) from it, which turns the shorter side; counted by squares of
        // lengths
        const double slip = std::sqrt(2.0) * kCell / std::sin(std::atan2(2.0, 4.0));
        const double shorter = degrees(std::atan2(slip, 2.0)) + cellBound(sideOf(radians(yaw_deg)), 2.0);
        const double longer = cellBound(sideOf(radians(yaw_deg)), 4.0 - slip);
        EXPECT_LE(axisError(o.box.yaw, sideOf(radians(yaw_deg))), (16.0 * longer + 4.0 * shorter) / 20.0) << yaw_deg;
    }
}

TEST(HullHeading, RefiningBringsItBelowTheBoundOfTheLongerSide) {
    for (double yaw_deg = -40.0; yaw_deg <= 40.0; yaw_deg += 5.0) {
        const double side = sideOf(radians(yaw_deg));
        EXPECT_LE(axisError(fitOutline(twoSides(radians(yaw_deg))).box.yaw, side), cellBound(side, 4.0)) << yaw_deg;
    }
}

TEST(HullHeading, TheMeanOfTwoSidesIsTakenModuloNinetyDegrees) {
    DetectorParams params;
    params.hull_fit.refine = false;
    // sides of the same length at 44.9 deg and 135.1 deg, which is -44.9 deg modulo 90: their mean is 45 deg, not 0
    for (const double bend : {radians(0.2), radians(-0.2)}) {
        const double turn = M_PI / 2 - std::atan2(1.02, 8.05);  // the first side at 45 deg
        const Obstacle o = fitOutline(twoSides(turn - 0.5 * bend, bend, 3.0, 3.0), params, {6.5, -4.0});
        ASSERT_EQ(o.rule, HeadingRule::TwoSides);
        EXPECT_LE(axisError(o.box.yaw, M_PI / 4), cellBound(M_PI / 4, 3.0));
    }
}

TEST(HullHeading, ALineIsFoundInEveryDirectionAlsoBetweenStrayCells) {
    for (double yaw_deg = -60.0; yaw_deg <= 60.0; yaw_deg += 5.0) {
        const Eigen::Vector2d middle(9.03, 0.52);
        const Eigen::Vector2d along(-std::sin(radians(yaw_deg)), std::cos(radians(yaw_deg)));
        auto outline = lineOf(middle - 1.7 * along, middle + 1.7 * along);
        for (const double s : {-1.2, 0.1, 0.9})  // a mirror, a roof rack: 3 cells of 70 off the line
            outline.emplace_back(middle + s * along + 0.3 * Eigen::Vector2d(along.y(), -along.x()));
        DetectorParams params;
        params.hull_fit.refine = false;
        const Obstacle o = fitOutline(outline, params);
        EXPECT_EQ(o.rule, HeadingRule::Line) << yaw_deg;
        EXPECT_LE(axisError(o.box.yaw, radians(yaw_deg)), cellBound(radians(yaw_deg), 3.4)) << yaw_deg;
        EXPECT_LE(headingError(o.box.yaw, radians(yaw_deg + 90.0)), 45.0) << "3.4 m: a side, not a rear";
    }
}

TEST(HullHeading, ReturnsTellALineWithoutTheErrorOfTheCells) {
    DetectorParams params;
    params.hull_fit.refine = false;
    params.hull_fit.line_from = LinePoints::Returns;
    for (double yaw_deg = -60.0; yaw_deg <= 60.0; yaw_deg += 5.0) {
        const Eigen::Vector2d along(-std::sin(radians(yaw_deg)), std::cos(radians(yaw_deg)));
        const Eigen::Vector2d middle(9.03, 0.52);
        const Obstacle o = fitOutline(lineOf(middle - 1.7 * along, middle + 1.7 * along), params);
        EXPECT_EQ(o.rule, HeadingRule::Line) << yaw_deg;
        EXPECT_LE(axisError(o.box.yaw, radians(yaw_deg)), 0.01) << yaw_deg;  // they lie on the line to a micrometre
    }
}

TEST(HullHeading, TheSameInputGivesTheSameBoxBitForBit) {
    for (const LinePoints from : {LinePoints::Cells, LinePoints::Returns}) {
        DetectorParams params;
        params.hull_fit.line_from = from;
        const Obstacle a = lookAt(carAt(12.0, 0.0, 3.0), fewPlanes(8), params).found;
        const Obstacle b = lookAt(carAt(12.0, 0.0, 3.0), fewPlanes(8), params).found;
        EXPECT_EQ(a.box.yaw, b.box.yaw);
        EXPECT_EQ(a.box.center, b.box.center);
        EXPECT_EQ(a.box.size, b.box.size);
        EXPECT_EQ(a.marks, b.marks);
    }
}

TEST(HullHeading, AnotherSeedTellsTheSameHeading) {
    const OrientedBox car = carAt(12.0, 0.0, 0.0);
    for (const int seed : {2, 77, 12345}) {
        DetectorParams params;
        params.hull_fit.seed = seed;
        EXPECT_LE(headingError(lookAt(car, fewPlanes(8), params).found.box.yaw, car.yaw), cellBound(car.yaw, 1.8));
    }
}

}  // namespace
}  // namespace lidar_obstacles
