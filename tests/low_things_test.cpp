// SPDX-License-Identifier: BSD-3-Clause
// Low things, drops and missing ground: found where they are, and not found where there are none.
#include "lidar_obstacles/low_things.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/pipelines.h"
#include "support/low_scenes.h"

namespace lidar_obstacles {
namespace {

using namespace test;

Sensor sensorAt(double height) {
    Sensor sensor;
    sensor.position.z() = height;
    sensor.noise = 0.02;
    return sensor;
}

std::vector<LowThing> lowIn(const World& world, const Sensor& sensor) {
    return detect(castRays(world, sensor).cloud, lookingLow()).low;
}

std::size_t count(const std::vector<LowThing>& low, LowKind kind) {
    return static_cast<std::size_t>(
        std::count_if(low.begin(), low.end(), [&](const auto& t) { return t.kind == kind; }));
}

/// Level ground up to x, and lower by this beyond.
World edgeAt(double x, double deep) {
    World world;
    world.ground = {{{0.0, 0.0}, 0.0, -kInfinity, x}, {{0.0, 0.0}, -deep, x, kInfinity}};
    return world;
}

TEST(LowThings, AreNoneOnFlatAndTiltedGround) {
    for (const double height : {0.5, 0.75, 1.2, 1.8})
        for (const double slope_deg : {0.0, 3.0, -5.0}) {
            SCOPED_TRACE(height);
            Sensor sensor = sensorAt(height);
            EXPECT_TRUE(lowIn(tiltedWorld(slope_deg, 0.5 * slope_deg), sensor).empty());
            sensor.axes = Eigen::AngleAxisd(radians(6.0), Eigen::Vector3d::UnitY()).toRotationMatrix();
            EXPECT_TRUE(lowIn(tiltedWorld(slope_deg, 0.0), sensor).empty());
        }
}

TEST(LowThings, AreNotTheFeetOfObstacles) {
    for (const double height : {0.5, 0.75, 1.8}) {
        SCOPED_TRACE(height);
        EXPECT_EQ(lowIn(street(), sensorAt(height)).size(), 0U);
    }
}

TEST(LowThings, HoldABrickWithItsHeight) {
    World world = flatWorld();
    world.boxes = {boxAt(1.8, 0.3, 20.0, {0.2, 0.2, 0.12})};
    const auto low = lowIn(world, sensorAt(0.5));
    ASSERT_EQ(low.size(), 1U);
    EXPECT_EQ(low[0].kind, LowKind::Raised);
    EXPECT_NEAR(low[0].box.center.x(), 1.75, 0.15);
    EXPECT_NEAR(low[0].box.center.y(), 0.3, 0.1);
    EXPECT_GT(low[0].height, 0.08);
    EXPECT_LT(low[0].height, 0.15);
    EXPECT_EQ(low[0].points.size(), low[0].spans.size());
}

TEST(LowThings, AreNoneInPlacesThatAreNotSearchedNorIsGroundMissingThere) {
    World world = flatWorld();
    world.boxes = {boxAt(1.8, 0.3, 20.0, {0.2, 0.2, 0.12})};
    const Scan scan = castRays(world, sensorAt(0.5));
    for (const char* excluded : {"box(1.5, 2.2, -0.5, 1)", "sector(-30, 40)"}) {
        DetectorParams params = lookingLow();
        params.region.excluded = excluded;
        EXPECT_TRUE(detect(scan.cloud, params).low.empty()) << excluded;
    }
    DetectorParams params = lookingLow();
    params.region.outline = "box(-5, 1.5, -5, 5)";
    EXPECT_TRUE(detect(scan.cloud, params).low.empty());
}

TEST(LowThings, LowerThanTheStepAreDrivenOver) {
    World world = flatWorld();
    world.boxes = {boxAt(1.8, 0.3, 20.0, {0.2, 0.2, 0.05})};
    EXPECT_TRUE(lowIn(world, sensorAt(0.5)).empty());
}

TEST(LowThings, HoldTheEdgeOfAPlatformBeforeItIsReached) {
    for (const double deep : {0.3, 0.55, 1.2}) {
        SCOPED_TRACE(deep);
        const auto low = lowIn(edgeAt(2.0, deep), sensorAt(0.5));
        ASSERT_GE(count(low, LowKind::Drop), 1U);
        float nearest = 100.0f;
        for (const LowThing& thing : low) {
            EXPECT_EQ(thing.kind, LowKind::Drop);
            EXPECT_NEAR(thing.height, -deep, 0.3);  // the level around bends down to the edge
            for (const LowSpan& s : thing.spans) {
                EXPECT_LE(s.from.norm(), s.to.norm() + 1e-4f);
                EXPECT_GT(s.to.x(), 1.95f);
                if (std::abs(s.to.y()) < 0.3f * s.to.x()) nearest = std::min(nearest, s.from.x());
            }
        }
        EXPECT_LT(nearest, 2.3f);  // the next ring on the ground ends 0.3 m before
        EXPECT_GT(nearest, 1.6f);
    }
}

TEST(LowThings, SayWhereNoGroundComesBack) {
    const Scan flat = castRays(flatWorld(), sensorAt(0.5));
    const Scan holed = without(flat, [&](std::int32_t i) {  // a puddle: 0.6 m to either side, 2 to 3 m ahead
        const Eigen::Vector3f& p = flat.cloud.xyz[static_cast<std::size_t>(i)];
        return p.x() > 2.0f && p.x() < 3.0f && std::abs(p.y()) < 0.6f;
    });
    const auto low = detect(holed.cloud, lookingLow()).low;
    ASSERT_GE(low.size(), 1U);
    for (const LowThing& thing : low) {
        EXPECT_EQ(thing.kind, LowKind::NoGround);
        EXPECT_TRUE(thing.points.empty());
        EXPECT_NEAR(thing.box.center.x(), 2.4, 0.5);  // from the last ring before it
        EXPECT_NEAR(thing.box.center.y(), 0.0, 0.2);
    }
    EXPECT_TRUE(detect(flat.cloud, lookingLow()).low.empty());
}

TEST(LowThings, AreTheSameWhereverTheTurnOfTheSensorBegins) {
    World world = flatWorld();
    world.boxes = {boxAt(1.8, 0.0, 20.0, {0.2, 0.2, 0.12})};
    for (const double turn_deg : {0.0, 90.0, 179.0, 180.0, 181.0}) {
        SCOPED_TRACE(turn_deg);
        Sensor sensor = sensorAt(0.5);
        sensor.axes = Eigen::AngleAxisd(radians(turn_deg), Eigen::Vector3d::UnitZ()).toRotationMatrix();
        const auto brick = lowIn(world, sensor);
        ASSERT_EQ(brick.size(), 1U);
        EXPECT_NEAR(brick[0].box.center.y(), 0.0, 0.05);
        EXPECT_NEAR(brick[0].box.size.x(), 0.25, 0.1);

        const Scan flat = castRays(flatWorld(), sensor);
        const Scan holed = without(flat, [&](std::int32_t i) {  // a puddle
            const Eigen::Vector3f& p = flat.cloud.xyz[static_cast<std::size_t>(i)];
            return p.x() > 2.0f && p.x() < 3.0f && std::abs(p.y()) < 0.3f;
        });
        const auto puddle = detect(holed.cloud, lookingLow()).low;
        ASSERT_EQ(puddle.size(), 1U);
        EXPECT_NEAR(puddle[0].box.center.y(), 0.0, 0.05);
        const double around = puddle[0].box.size.x() + puddle[0].box.size.y();
        EXPECT_NEAR(around, 0.94, 0.05);  // 0.4 deep: from the last ring before it

        const auto low = lowIn(edgeAt(2.0, 0.55), sensor);
        const auto widest = std::max_element(low.begin(), low.end(), [](const LowThing& a, const LowThing& b) {
            return a.box.size.x() < b.box.size.x();
        });
        ASSERT_NE(widest, low.end());
        EXPECT_GT(widest->box.size.x(), 4.0);  // the edge, in one piece
        EXPECT_NEAR(widest->box.center.y(), 0.0, 0.3);
    }
}

TEST(LowThings, HoldAPitThatOnlyTheLowestRingMeets) {
    World world = flatWorld();
    world.ground = {{{0.0, 0.0}, 0.0, -kInfinity, 1.82}, {{0.0, 0.0}, -0.3, 1.82, 4.0}};
    Sensor sensor = sensorAt(0.5);
    sensor.planes = 2;
    sensor.step_deg = 20.0;
    for (const double turn_deg : {0.0, 180.0}) {
        sensor.axes = Eigen::AngleAxisd(radians(turn_deg), Eigen::Vector3d::UnitZ()).toRotationMatrix();
        EXPECT_GE(count(lowIn(world, sensor), LowKind::Drop), 1U) << turn_deg;
    }
}

TEST(LowThings, AreNotLookedForWhereThatIsSwitchedOff) {
    DetectorParams params;
    params.low.enabled = false;
    const PointCloud cloud = castRays(edgeAt(2.0, 0.5), sensorAt(0.5)).cloud;
    EXPECT_TRUE(detect(cloud, params).low.empty());
    EXPECT_EQ(detect(cloud, params).obstacles.size(), detect(cloud, lookingLow()).obstacles.size());
}

TEST(LowThings, AreSeenFromAPlatformThatTheVehicleStandsOn) {  // whatever level the model of the ground took
    World world;
    world.ground = {
        {{0.0, 0.0}, -1.0, -kInfinity, -2.2}, {{0.0, 0.0}, 0.0, -2.2, 2.2}, {{0.0, 0.0}, -1.0, 2.2, kInfinity}};
    const auto low = lowIn(world, sensorAt(0.5));
    EXPECT_GE(count(low, LowKind::Drop), 1U);
    EXPECT_EQ(count(low, LowKind::Raised), 0U);
}

TEST(LowScenes, AreFoundOnTheWayThere) {
    for (const LowScene& scene : lowScenes()) {
        const FoundAt found = foundFrom(scene, 0.5, 1.2);
        double nearest = 100.0;
        for (std::size_t k = 0; k < found.found.size(); ++k)
            if (found.found[k]) nearest = std::min(nearest, found.distances[k]);
        EXPECT_LE(nearest, 3.5) << scene.name << ": " << toText(found);
    }
}

}  // namespace
}  // namespace lidar_obstacles
