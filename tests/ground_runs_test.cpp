// SPDX-License-Identifier: BSD-3-Clause
// What runs of returns along a plane of the sensor tell of the ground, where its fitted planes do not.
#include "ground/ground_runs.h"

#include <gtest/gtest.h>

#include "lidar_obstacles/ground.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr double kRampFrom = 12.0;  // [m]

/// Level ground that rises by 6 % from 12 m ahead on; the plane of -3 deg meets it at 22 m, 0.6 m above the level.
World rampWorld() {
    const double slope = 0.06;
    GroundStrip level, ramp;
    level.x_max = kRampFrom;
    ramp.x_min = kRampFrom;
    ramp.slope.x() = slope;
    ramp.offset = -slope * kRampFrom;
    return {{level, ramp}, {}};
}

/// A model that knows the level ground alone: what lies 0.25 m above it is not labelled.
GroundModel levelGround(const Scan& scan) {
    GroundModel model = knownGround(scan.cloud);
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) model.is_ground[i] = model.height[i] < 0.25f;
    return model;
}

/// Ends the beam of one plane in every so many columns 3 m from the sensor.
void rainOn(Scan& scan, int ring, int every) {
    for (int column = 0; column < scan.cloud.view.columns; column += every) {
        const std::int32_t i = scan.cloud.view.at(ring, column);
        if (i < 0) continue;
        const Eigen::Vector3f& o = scan.cloud.sensor_origin;
        scan.cloud.xyz[i] = o + 3.0f * (scan.cloud.xyz[i] - o).normalized();
        scan.hit[i] = 99;
    }
}

/// Returns on the ground without its label, of the planes up to that of -3 deg: the next ones meet no level ground.
int unlabelled(const Scan& scan, const GroundModel& model) {
    const auto on_ground = scan.returnsOn(kOnGround);
    return static_cast<int>(std::count_if(on_ground.begin(), on_ground.end(), [&](std::int32_t i) {
        return scan.cloud.ring[i] <= 6 && model.is_ground[i] == 0;
    }));
}

TEST(RisingGround, IsGround) {
    const Scan scan = castRays(rampWorld(), Sensor{});
    EXPECT_EQ(unlabelled(scan, segmentGround(scan.cloud, GroundParams{})), 0);
}

TEST(RisingGround, IsGroundBehindRain) {
    Scan scan = castRays(rampWorld(), Sensor{});
    for (int ring = 0; ring < 16; ++ring) rainOn(scan, ring, 5);
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    EXPECT_EQ(unlabelled(scan, model), 0);
    for (const std::int32_t i : scan.returnsOn(99)) ASSERT_FALSE(model.is_ground[i]) << "a drop";
}

TEST(RisingGround, IsGroundWhereSomethingNearerHidesHalfOfIt) {
    World world = rampWorld();
    world.boxes = {boxAt(8.0, 10.0, 0.0, {1.0, 20.0, 3.0})};  // the left half of the ramp is behind it
    const Scan scan = castRays(world, Sensor{});
    EXPECT_EQ(unlabelled(scan, segmentGround(scan.cloud, GroundParams{})), 0);
}

TEST(RisingGround, DoesNotRiseOntoThings) {
    World world = flatWorld();
    world.boxes = {carAt(20.0, 3.0, 10.0), personAt(12.0, -4.0), boxAt(15.0, -10.0, 0.0, {0.3, 2.0, 0.5}),
                   carAt(-18.0, 5.0, 80.0), boxAt(0.0, 6.0, 0.0, {40.0, 0.3, 1.0})};
    const Scan scan = castRays(world, Sensor{});
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
        if (scan.hit[i] == kOnGround) {
            EXPECT_NEAR(model.height[i], 0.0f, 0.05f);
        } else if (scan.cloud.xyz[i].z() > 0.3f) {
            EXPECT_FALSE(model.is_ground[i]);
        }
    }
}

TEST(StandingRuns, AreNotWhereTheSurfaceDips) {
    // level ground, and a surface that lies 0.23 m too low in one direction: nothing stands there
    const Scan scan = castRays(flatWorld(), Sensor{});
    GroundModel model;
    model.sectors = 12;
    model.ranges = {1.0, 60.0};
    model.rise.assign(24, 0.0);
    model.rise[14] = model.rise[15] = -0.23;
    model.is_ground.assign(scan.cloud.size(), 1);
    for (const Eigen::Vector3f& p : scan.cloud.xyz)
        model.height.push_back(p.z() - static_cast<float>(model.heightAt(p.x(), p.y())));
    keepStandingRuns(scan.cloud, model);
    EXPECT_EQ(unlabelled(scan, model), 0);
}

TEST(StandingRuns, AreFoundWhereRainFallsBeforeThem) {
    // a box 0.2 m high is labelled ground by its height; the beams that it cuts short tell that it stands
    World world = flatWorld();
    world.boxes = {boxAt(20.0, 0.0, 0.0, {1.0, 2.0, 0.24})};
    Sensor sensor;
    sensor.lowest_deg = -14.6;  // the plane of -4.6 deg hits it
    Scan scan = castRays(world, sensor);
    const auto labelledOnTop = [&scan](const GroundModel& model) {
        const auto on_box = scan.returnsOn(0);
        return std::count_if(on_box.begin(), on_box.end(),
                             [&](int i) { return model.is_ground[i] && scan.cloud.xyz[i].z() > 0.2f; });
    };
    for (const bool rain : {false, true}) {
        if (rain)
            for (int ring = 0; ring < 16; ++ring) rainOn(scan, ring, 7);
        GroundModel model = levelGround(scan);
        ASSERT_GT(labelledOnTop(model), 3);
        keepStandingRuns(scan.cloud, model);
        EXPECT_EQ(labelledOnTop(model), 0) << (rain ? "rain" : "clear");
    }
}

TEST(StandingRuns, AreFoundWhereTheyLiftedTheSurface) {
    // a box that one plane meets 0.23 m above the ground, and a surface that was drawn half way up to it
    World world = flatWorld();
    world.boxes = {boxAt(20.0, 0.0, 0.0, {1.0, 4.0, 0.4})};
    Sensor sensor;
    sensor.lowest_deg = -14.6;
    const Scan scan = castRays(world, sensor);
    GroundModel model = levelGround(scan);
    const std::vector<std::int32_t> on_box = scan.returnsOn(0);
    ASSERT_GT(on_box.size(), 20u);
    for (const std::int32_t i : on_box) model.height[i] -= 0.13f, model.is_ground[i] = 1;
    keepStandingRuns(scan.cloud, model);
    for (const std::int32_t i : on_box) EXPECT_FALSE(model.is_ground[i]) << scan.cloud.xyz[i].transpose();
}

TEST(RisingGround, DoesNotRiseOntoBumpersThatNoGroundLeadsUpTo) {
    // eight planes: cars all around, each met by one of them a quarter of a metre up; no beam between them comes back
    for (const double x : {12.4, 12.7}) {
        Sensor sensor = fewPlanes(8);
        sensor.max_range = x + 0.6;
        World world = flatWorld();
        for (double yaw = 0.0; yaw < 359.0; yaw += 15.0) {
            const double a = yaw * M_PI / 180.0;
            world.boxes.push_back(boxAt((x + 2.1) * std::cos(a), (x + 2.1) * std::sin(a), yaw, {4.2, 1.8, 0.9}));
        }
        const Scan scan = castRays(world, sensor);
        const GroundModel ground = segmentGround(scan.cloud, GroundParams{});
        const std::vector<std::int32_t> bumper = scan.returnsOn(0);
        ASSERT_GT(bumper.size(), 30u);
        for (const std::int32_t i : bumper) EXPECT_FALSE(ground.is_ground[i]) << ground.height[i] << " at " << x;
    }
}

TEST(StandingRuns, AreNotBetweenMirrorImagesInAWetRoad) {
    // shots that a puddle sends on come back from behind the ground: between them it stands no higher than elsewhere
    Scan scan = castRays(flatWorld(), Sensor{});
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
        const int column = scan.cloud.view.column_of[i];
        if (column % 9 != 0 && column % 13 != 0) continue;
        scan.cloud.xyz[i] += 0.6f * (scan.cloud.xyz[i] - scan.cloud.sensor_origin);
        scan.hit[i] = 99;
    }
    GroundModel model = levelGround(scan);
    keepStandingRuns(scan.cloud, model);
    EXPECT_EQ(unlabelled(scan, model), 0);
}

TEST(GroundSeeds, StayWhereADropFallsBeforeThem) {
    // the plane of -3 deg is the last that meets the ground, at 34 m; drops are all that the next one up sees
    Scan scan = castRays(flatWorld(), Sensor{});
    const auto seedsOfRing = [&](int ring) {
        const auto seeds = groundSeeds(scan.cloud, azimuthBins(scan.cloud));
        return std::count_if(seeds.begin(), seeds.end(), [&](const GroundSeed& s) { return s.row == ring; });
    };
    ASSERT_EQ(seedsOfRing(6), kSeedBins);
    ASSERT_EQ(seedsOfRing(7), 0);
    for (int column = 0; column < scan.cloud.view.columns; column += 10) {
        const Eigen::Vector3f& far = scan.cloud.xyz[scan.cloud.view.at(6, column)];
        const Eigen::Vector3f away(far.x(), far.y(), 0.0f);
        scan.cloud.view.at(7, column) = static_cast<std::int32_t>(scan.cloud.size());
        scan.cloud.xyz.push_back(scan.cloud.sensor_origin + 3.0f * away.normalized());
        scan.cloud.ring.push_back(7);
        scan.cloud.view.column_of.push_back(column);
    }
    EXPECT_EQ(seedsOfRing(6), kSeedBins);
    EXPECT_EQ(seedsOfRing(7), 0) << "drops are no seeds";
}

}  // namespace
}  // namespace lidar_obstacles
