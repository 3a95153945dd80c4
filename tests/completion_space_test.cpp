// SPDX-License-Identifier: BSD-3-Clause
// What limits the growth of a vehicle's unseen sides: beams and returns of anything else.
#include <gtest/gtest.h>

#include "lidar_obstacles/completion.h"
#include "lidar_obstacles/plane_fit.h"
#include "support/hull_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using Vec2 = Eigen::Vector2d;

const CompletionParams kParams;
const BoxParams& kBox = kParams.box;

World with(const std::vector<OrientedBox>& boxes) {
    World world = flatWorld();
    world.boxes = boxes;
    return world;
}

/// Scan of a world with the true ground of its returns, also after it was told in another frame.
struct Seen {
    Scan scan;
    GroundModel ground;
};

Seen look(const World& world, const Sensor& sensor = {}) {
    Seen seen{castRays(world, sensor), {}};
    seen.ground = knownGround(seen.scan);
    return seen;
}

/// The completed box of the world's first object, whose seen part is `box`.
OrientedBox grown(const Seen& seen, const OrientedBox& box, const CompletionParams& params = {}) {
    Obstacle o;
    o.cls = ObstacleClass::Vehicle;
    o.heading_valid = true;
    o.box = box;
    o.points = seen.scan.returnsOn(0);
    return completeBoxes({o}, seen.scan.cloud, seen.ground, params)[0].box;
}

double frontOf(const OrientedBox& box) { return box.center.x() + 0.5 * box.size.x(); }

/// The rear of a car whose rear face is at x, of which nothing else is seen.
OrientedBox rearAt(double x, double y = 0.0) { return boxAt(x + 0.05, y, 0.0, {0.1, 1.7, 1.5}); }

TEST(CompletionSpace, AWallInFrontStopsTheGrowth) {
    for (const double gap : {1.0, 2.0, 3.0}) {
        // 3 m high: seen over the roof of what stands before it
        const Seen seen = look(with(
            {boxAt(8.0 + 0.5 * 0.8, 0.0, 0.0, {0.8, 1.7, 1.5}), boxAt(8.0 + gap + 0.15, 0.0, 0.0, {0.3, 8.0, 3.0})}));
        EXPECT_NEAR(frontOf(grown(seen, rearAt(8.0))), 8.0 + gap, 1e-3) << gap;
    }
}

TEST(CompletionSpace, ACarOfWhichOnlyTheRoofIsSeenStandsUnderIt) {
    // so high a sensor that its lowest ring, 15 degrees down, goes over the nearer half of the roof
    const OrientedBox car = boxAt(0.0, 3.4, 0.0, {4.3, 1.7, 1.45});
    Sensor high;
    high.position.z() = 2.3;
    const Seen seen = look(with({car}), high);
    ASSERT_FALSE(seen.scan.returnsOn(0).empty());
    for (const std::int32_t i : seen.scan.returnsOn(0)) ASSERT_GT(seen.ground.height[i], 1.4);
    const OrientedBox box = grown(seen, boxAt(0.0, 3.7, 0.0, {2.5, 1.1, 1.45}));
    EXPECT_NEAR(box.center.y(), 3.7, 0.2) << "not pushed away from the roof";
    EXPECT_NEAR(box.center.x(), 0.0, 0.2);
    EXPECT_NEAR(box.size.x(), kBox.car_length, 0.2);
    EXPECT_NEAR(box.size.y(), kBox.car_width, 0.2);
}

TEST(CompletionSpace, ASideThatIsSeenFromAboveTheWindowsOnStaysWhereItIs) {
    // a van beside the same sensor: its side is hit, above the windows of a car
    Sensor high;
    high.position.z() = 2.3;
    const Seen seen = look(with({boxAt(0.0, 4.2, 0.0, {5.0, 2.0, 2.2})}), high);
    const OrientedBox box = grown(seen, boxAt(0.0, 3.3, 0.0, {5.0, 0.2, 2.2}));
    EXPECT_NEAR(box.center.y() - 0.5 * box.size.y(), 3.2, 1e-6);
}

TEST(CompletionSpace, AnotherVehicleInFrontStopsTheGrowth) {
    const Seen seen = look(with({boxAt(8.4, 0.0, 0.0, {0.8, 1.7, 1.5}), boxAt(13.0, 0.0, 0.0, {5.0, 2.0, 2.4})}));
    EXPECT_NEAR(frontOf(grown(seen, rearAt(8.0))), 10.5, 1e-3);
}

TEST(CompletionSpace, TheBodyOfATruckAboveItsCabIsNoWallBehindIt) {
    // seen above the region only, over the cab's roof
    const OrientedBox cab = boxAt(10.0, 0.0, 0.0, {2.0, 2.3, 2.3});
    const Seen seen = look(with({cab, {{13.5, 0.0, 3.0}, {4.0, 2.3, 0.9}, 0.0}}));
    int above = 0;
    for (const std::int32_t i : seen.scan.returnsOn(1)) above += seen.ground.height[i] > kParams.region.max_height;
    ASSERT_GT(above, 10);
    ASSERT_EQ(above, static_cast<int>(seen.scan.returnsOn(1).size()));
    EXPECT_NEAR(grown(seen, cab).size.x(), kBox.tall_length, 1e-9);
    CompletionParams higher;
    higher.region.max_height = 4.0;
    EXPECT_NEAR(frontOf(grown(seen, cab, higher)), 11.5, 0.01) << "all that stands in the region stops it";
}

TEST(CompletionSpace, BehindTheUsualLengthNothingMatters) {
    const Seen seen = look(with({carAt(10.0, 0.0, 0.0), boxAt(13.0, 0.0, 0.0, {0.3, 8.0, 3.0})}));
    EXPECT_NEAR(grown(seen, rearAt(7.75)).size.x(), kBox.car_length, 1e-9);
}

/// A box 2 m long that stands left of the way ahead, its rear at 7 m and its right side at 3.1 m, turned to the sensor.
const OrientedBox kShort = boxAt(8.0, 4.0, 0.0, {2.0, 1.8, 1.5});

/// The farthest that kShort may grow [m] where beams cross the space before it at the height of its body: as near to it
/// as a beam that passes its front right corner at (9, 3.1) enters the strip, which is 0.2 m narrower than the box on
/// either side: 0.2 * 9 / 3.1, and three columns on, each r * 0.2 deg / sin of 19 deg apart.
constexpr double kShortFront = 9.0 + 0.2 * 9.0 / 3.1 + 3.0 * 9.5 * 0.0035 / 0.33;

TEST(CompletionSpace, BeamsThatCrossAtTheHeightOfTheBodyStopTheGrowth) {
    // they end on a wall behind it, or on the ground
    const Seen wall = look(with({kShort, boxAt(10.0, 9.0, 0.0, {20.0, 0.3, 3.0})}));
    EXPECT_LE(frontOf(grown(wall, kShort)), kShortFront);
    EXPECT_LE(frontOf(grown(look(with({kShort})), kShort)), kShortFront);
}

TEST(CompletionSpace, WithoutSuchBeamsItGrows) {
    World nothing_else;
    nothing_else.boxes = {kShort};
    EXPECT_NEAR(grown(look(nothing_else), kShort).size.x(), kBox.car_length, 1e-9);
    // on a wall 2 m and more up, reached by beams that rise above the body
    World above = nothing_else;
    above.boxes.push_back({{10.0, 9.0, 4.0}, {20.0, 0.3, 4.0}, 0.0});
    EXPECT_NEAR(grown(look(above), kShort).size.x(), kBox.car_length, 1e-9);
}

TEST(CompletionSpace, BeamsThatGoThroughBelowTheBellyStopNothing) {
    // a van whose rear ends 0.35 m above the ground: the rings that pass below it end on the ground under it
    const OrientedBox rear{{9.0, 0.0, 1.35}, {0.3, 1.9, 2.0}, 0.0};
    Sensor high;
    high.position.z() = 2.0;
    const Seen seen = look(with({rear}), high);
    int below = 0;
    for (std::size_t i = 0; i < seen.scan.cloud.size(); ++i) {
        const Eigen::Vector3f& p = seen.scan.cloud.xyz[i];
        below += p.x() > 9.1f && p.x() < 13.0f && std::abs(p.y()) < 0.6f && p.z() < 0.1f ? 1 : 0;
    }
    ASSERT_GT(below, 10);
    EXPECT_NEAR(grown(seen, rear).size.x(), kBox.car_length, 1e-9);
}

TEST(CompletionSpace, TwoStrayBeamsStopNothing) {
    World world;
    world.boxes = {kShort};
    Seen seen = look(world, Sensor{});
    for (int k = 0; k < 3; ++k) {
        const OrientedBox box = grown(seen, kShort);
        EXPECT_NEAR(box.size.x(), kBox.car_length, 1e-9) << k << " returns inside";
        // one more return in the middle of where it would grow to, in the scan's list and its view
        const Eigen::Vector3f p(10.0f, 4.0f, 0.8f);
        PointCloud& cloud = seen.scan.cloud;
        const double turn = M_PI - std::atan2(p.y(), p.x());
        const int column = static_cast<int>(turn / (2.0 * M_PI) * cloud.view.columns) + k;
        cloud.view.at(0, column) = static_cast<std::int32_t>(cloud.size());
        cloud.view.column_of.push_back(column);
        cloud.ring.push_back(0);
        cloud.xyz.push_back(p);
        seen.scan.hit.push_back(1);
        seen.ground = knownGround(seen.scan);
    }
    EXPECT_NEAR(frontOf(grown(seen, kShort)), 10.0, 1e-3) << "three do";
}

TEST(CompletionSpace, AVehicleAlongsideALongWallDoesNotGrowIntoIt) {
    // only its right side is seen; the wall, higher than it, is seen above it
    const Seen seen = look(with({boxAt(0.0, 5.5, 0.0, {4.5, 0.6, 1.4}), boxAt(0.0, 6.6, 0.0, {30.0, 0.2, 4.0})}));
    const OrientedBox box = grown(seen, boxAt(0.0, 5.25, 0.0, {4.5, 0.1, 1.4}));
    EXPECT_NEAR(box.center.y() - 0.5 * box.size.y(), 5.2, 1e-9);
    EXPECT_LE(box.center.y() + 0.5 * box.size.y(), 6.5 + 1e-3);
}

/// Growth with a wall at 10.5 m as AWallInFrontStopsTheGrowth has it.
World walled() { return with({boxAt(8.4, 0.0, 0.0, {0.8, 1.7, 1.5}), boxAt(10.65, 0.0, 0.0, {0.3, 8.0, 3.0})}); }

TEST(CompletionSpace, ACloudWithoutRingsTellsTheSame) {
    Sensor sensor;
    sensor.rings = false;
    EXPECT_NEAR(frontOf(grown(look(walled(), sensor), rearAt(8.0))), 10.5, 1e-3);
    EXPECT_LE(frontOf(grown(look(with({kShort}), sensor), kShort)), kShortFront);
    EXPECT_NEAR(grown(look(with({carAt(10.0, 0.0, 0.0)}), sensor), rearAt(7.75)).size.x(), kBox.car_length, 1e-9);
}

TEST(CompletionSpace, ASensorTurnedOrTiltedInAnyWayTellsTheSame) {
    for (const double turn : {0.0, 37.0, 90.0, 180.0, -100.0})
        for (const double tilt : {0.0, 3.0}) {
            // the frame turns, the columns of the view stay with the sensor
            const Eigen::Matrix3d rotation = (Eigen::AngleAxisd(radians(turn), Eigen::Vector3d::UnitZ()) *
                                              Eigen::AngleAxisd(radians(tilt), Eigen::Vector3d::UnitY()))
                                                 .toRotationMatrix();
            Seen seen = look(walled());  // the ground's heights are told before the turn
            seen.scan = moved(seen.scan, rotation, {0.7, -0.4, 0.0});
            OrientedBox rear = rearAt(8.0);
            rear.yaw += radians(turn);
            rear.center = rotation * rear.center + Eigen::Vector3d(0.7, -0.4, 0.0);
            const OrientedBox box = grown(seen, rear);
            // returns on the wall up to 3 m move by 3 m * sin(3 deg) when it tilts
            EXPECT_NEAR(box.size.x(), 2.5, 0.001 + 3.0 * std::sin(radians(tilt))) << turn << ", " << tilt;
        }
}

TEST(CompletionSpace, ASensorThatTurnsTheOtherWayTellsTheSame) {
    Seen seen = look(walled());
    OrganizedView& view = seen.scan.cloud.view;
    for (int ring = 0; ring < view.rings; ++ring) {
        const auto row = view.index.begin() + static_cast<std::ptrdiff_t>(ring) * view.columns;
        std::reverse(row, row + view.columns);
    }
    for (std::int32_t& column : view.column_of) column = view.columns - 1 - column;
    EXPECT_NEAR(frontOf(grown(seen, rearAt(8.0))), 10.5, 1e-3);
}

TEST(CompletionSpace, ThePartOfACarThatIsSeenDoesNotStopItself) {
    // the roof's and the far side's returns lie where the box grows to
    const Seen seen = look(with({carAt(9.0, 1.5, 10.0)}));
    const Obstacle o = fitPlaneBox(clusterOf(seen.scan.returnsOn(0), seen.ground), seen.scan.cloud, seen.ground, {});
    OrientedBox rear = o.box;
    const Vec2 forward(std::cos(rear.yaw), std::sin(rear.yaw));
    rear.center.head<2>() -= 0.5 * (rear.size.x() - 0.5) * forward;
    rear.size.x() = 0.5;
    EXPECT_NEAR(grown(seen, rear).size.x(), kBox.car_length, 1e-9);
}

/// The part of a car's near side that is seen beside a post that may stand before it; the car is the first box.
OrientedBox seenSideOf(const Seen& seen) {
    Eigen::AlignedBox2d side;
    for (const std::int32_t i : seen.scan.returnsOn(0)) side.extend(seen.scan.cloud.xyz[i].head<2>().cast<double>());
    return boxAt(side.center().x(), side.max().y() - 0.05, 0.0, {side.sizes().x(), 0.1, 1.5});
}

TEST(CompletionSpace, AnEndThatSomethingHidesIsNoEnd) {
    const OrientedBox car = boxAt(12.0, -4.0, 0.0, {4.1, 1.7, 1.5});
    for (const bool hidden : {false, true}) {
        std::vector<OrientedBox> boxes = {car};
        if (hidden) boxes.push_back(boxAt(5.0, -2.0, 0.0, {0.6, 1.0, 2.2}));  // before its rear
        const Seen seen = look(with(boxes));
        const OrientedBox side = seenSideOf(seen);
        ASSERT_EQ(side.size.x() < 3.0, hidden) << side.size.transpose();
        const OrientedBox box = grown(seen, side);
        EXPECT_NEAR(box.center.x(), car.center.x(), 0.5) << hidden;
        EXPECT_NEAR(frontOf(box), frontOf(car), 0.5) << "its front is seen to end there";
    }
}

TEST(CompletionSpace, AFaceThatIsSeenIsAnEndWhateverStandsBeforeIt) {
    // beams to the rear of a van go over the car behind it
    const Seen seen = look(with({boxAt(14.0, 0.0, 0.0, {4.0, 1.9, 2.4}), carAt(8.0, 0.0, 0.0)}));
    const OrientedBox box = grown(seen, boxAt(12.05, 0.0, 0.0, {0.1, 1.9, 2.4}));
    EXPECT_NEAR(box.center.x() - 0.5 * box.size.x(), 12.0, 0.01);
}

}  // namespace
}  // namespace lidar_obstacles
