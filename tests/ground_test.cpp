// SPDX-License-Identifier: BSD-3-Clause
// What is ground on level and tilted ground, told by where the rays of a known world end.
#include "lidar_obstacles/ground.h"

#include <gtest/gtest.h>

#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr double kNoise = 0.02;  // of the range, as the manual of the VLP-16 tells

/// Five cars and two people standing on a world's ground.
World withTraffic(World world) {
    for (const OrientedBox& box :
         {carAt(12.0, 1.0, 0.0), carAt(20.0, -4.0, 10.0), carAt(-11.0, 3.0, 180.0), carAt(4.0, 4.0, 0.0),
          carAt(-6.0, -5.0, 80.0), personAt(9.0, -4.0), personAt(3.0, -6.0)})
        world.boxes.push_back(standOn(world, box));
    return world;
}

Sensor noisySensor(double height = 1.8) {
    Sensor sensor;
    sensor.position.z() = height;
    sensor.noise = kNoise;
    return sensor;
}

/// Share of the ground's returns within `range` that are labelled ground.
double groundFound(const Scan& scan, const GroundModel& model, double range = 60.0) {
    double all = 0.0;
    double found = 0.0;
    for (const std::int32_t i : scan.returnsOn(kOnGround)) {
        if ((scan.cloud.xyz[i] - scan.cloud.sensor_origin).norm() > range) continue;
        all += 1.0;
        found += model.is_ground[i];
    }
    EXPECT_GT(all, 300.0) << "the world shows too little ground for this fact";
    return found / all;
}

/// Share of the returns higher than 0.4 m on boxes that are labelled ground. `world` tells where its ground is;
/// `back` brings returns into its frame.
double objectsLost(const World& world, const Scan& scan, const GroundModel& model,
                   const Eigen::Isometry3d& back = Eigen::Isometry3d::Identity()) {
    double all = 0.0;
    double lost = 0.0;
    for (std::size_t i = 0; i < scan.hit.size(); ++i) {
        const Eigen::Vector3d p = back * scan.cloud.xyz[i].cast<double>();
        if (scan.hit[i] == kOnGround || p.z() - world.ground.at(0).heightAt(p.x(), p.y()) < 0.4) continue;
        all += 1.0;
        lost += model.is_ground[i];
    }
    EXPECT_GT(all, 300.0) << "the world shows too few objects for this fact";
    return lost / all;
}

double normalError(const GroundModel& model, const GroundStrip& truth) {
    const Eigen::Vector3d normal = Eigen::Vector3d(-truth.slope.x(), -truth.slope.y(), 1.0).normalized();
    return degrees(std::acos(std::min(1.0, normal.dot(model.normal))));
}

/// The facts that hold for any plane the ground may be: what is ground, what is not, how it lies.
void expectGroundFound(const World& world, const Sensor& sensor) {
    const Scan scan = castRays(world, sensor);
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    EXPECT_NE(model.evidence, GroundEvidence::None);
    EXPECT_GE(groundFound(scan, model), 0.98);
    EXPECT_LE(objectsLost(world, scan, model), 0.02);
    EXPECT_LE(normalError(model, world.ground[0]), 0.5);
}

TEST(Ground, AnEmptyCloudHasNoGround) {
    const GroundModel model = segmentGround(PointCloud{}, GroundParams{});
    EXPECT_EQ(model.evidence, GroundEvidence::None);
    EXPECT_TRUE(model.is_ground.empty());
    EXPECT_TRUE(model.height.empty());
    EXPECT_EQ(model.heightAt(3.0, -2.0), 0.0);
}

TEST(Ground, OneReturnIsNoGroundAndItsHeightIsItsZ) {
    const GroundModel model = segmentGround(cloudOf({{5.0f, 0.0f, 0.1f}}), GroundParams{});
    EXPECT_EQ(model.evidence, GroundEvidence::None);
    ASSERT_EQ(model.is_ground.size(), 1u);
    EXPECT_EQ(model.is_ground[0], 0);
    EXPECT_FLOAT_EQ(model.height[0], 0.1f);
}

TEST(Ground, ManyReturnsOnOneSpotAreNoGround) {
    const GroundModel model =
        segmentGround(cloudOf(std::vector<Eigen::Vector3f>(1000, {5.0f, 0.0f, 0.0f})), GroundParams{});
    EXPECT_EQ(model.evidence, GroundEvidence::None);
}

TEST(Ground, LevelGroundIsFoundBetweenTraffic) { expectGroundFound(withTraffic(flatWorld()), noisySensor()); }

TEST(Ground, LevelGroundHasGoodEvidenceAndLiesWithinAFewCentimetres) {
    const Scan scan = castRays(withTraffic(flatWorld()), noisySensor());
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    EXPECT_EQ(model.evidence, GroundEvidence::Good);
    for (double angle = 0.0; angle < 2 * M_PI; angle += 0.3)
        for (const double range : {4.0, 8.0, 15.0}) {
            // range noise tilted by the beam: below 0.02 * sin 15 deg; the rest is what objects' feet pull
            EXPECT_NEAR(model.heightAt(range * std::cos(angle), range * std::sin(angle)), 0.0, 0.05);
        }
}

TEST(Ground, SlopesAndBankingOfFiveDegreesAreFollowed) {
    for (const double pitch : {-5.0, 0.0, 5.0})
        for (const double bank : {-5.0, 0.0, 5.0}) {
            SCOPED_TRACE("pitch " + std::to_string(pitch) + ", bank " + std::to_string(bank));
            if (std::hypot(pitch, bank) > 5.0) continue;  // each alone; both at once are 7 deg
            expectGroundFound(withTraffic(tiltedWorld(pitch, bank)), noisySensor());
        }
}

TEST(Ground, ALowSensorAndAHighOneSeeTheGround) {
    for (const double height : {0.6, 2.5}) {
        SCOPED_TRACE(height);
        expectGroundFound(withTraffic(flatWorld()), noisySensor(height));
    }
}

TEST(Ground, AMountingErrorOfTwoDegreesDoesNotHideTheGround) {
    const World world = withTraffic(flatWorld());
    for (const Eigen::Vector3d& axis :
         {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(1, 0, 0)}) {
        const Eigen::Matrix3d wrong = Eigen::AngleAxisd(radians(2.0), axis).toRotationMatrix();
        const Scan scan = moved(castRays(world, noisySensor()), wrong, Eigen::Vector3d::Zero());
        const GroundModel model = segmentGround(scan.cloud, GroundParams{});
        EXPECT_GE(groundFound(scan, model), 0.98);
        EXPECT_LE(objectsLost(world, scan, model, Eigen::Isometry3d(wrong.transpose())), 0.02);
        EXPECT_LE(degrees(std::acos(std::min(1.0, model.normal.dot(wrong.col(2))))), 0.5);
    }
}

TEST(Ground, AWrongSensorHeightDoesNotHideTheGround) {
    const World world = withTraffic(flatWorld());
    for (const double shift : {-2.5, -1.8, 1.0}) {
        SCOPED_TRACE(shift);
        const Eigen::Vector3d down(0.0, 0.0, shift);
        const Scan scan = moved(castRays(world, noisySensor()), Eigen::Matrix3d::Identity(), down);
        const GroundModel model = segmentGround(scan.cloud, GroundParams{});
        EXPECT_GE(groundFound(scan, model), 0.98);
        EXPECT_LE(objectsLost(world, scan, model, Eigen::Isometry3d(Eigen::Translation3d(-down))), 0.02);
        EXPECT_NEAR(model.heightAt(5.0, 5.0), shift, 0.05);
    }
}

TEST(Ground, AKerbAndTheWalkBehindItAreGround) {
    World world = withTraffic(flatWorld());
    const int walk = static_cast<int>(world.boxes.size());
    world.boxes.push_back(boxAt(0.0, 11.0, 0.0, {100.0, 8.0, 0.15}));
    const Scan scan = castRays(world, noisySensor());
    const GroundModel model = segmentGround(scan.cloud, GroundParams{});
    const auto on_walk = scan.returnsOn(walk);
    const auto labelled = std::count_if(on_walk.begin(), on_walk.end(), [&](int i) { return model.is_ground[i] != 0; });
    ASSERT_GT(on_walk.size(), 500u);
    EXPECT_GE(static_cast<double>(labelled), 0.98 * static_cast<double>(on_walk.size()));
    EXPECT_GE(groundFound(scan, model), 0.98);
    EXPECT_LE(objectsLost(world, scan, model), 0.02);
}

TEST(Ground, ARampAheadIsGround) {
    constexpr double kStart = 12.0;
    for (const double slope_deg : {-6.0, -4.0, 4.0, 6.0}) {
        SCOPED_TRACE(slope_deg);
        World world = flatWorld();
        world.ground[0].x_max = kStart;
        GroundStrip ramp;
        ramp.slope.x() = std::tan(radians(slope_deg));
        ramp.offset = -kStart * ramp.slope.x();
        ramp.x_min = kStart;
        world.ground.push_back(ramp);
        const Scan scan = castRays(world, noisySensor());
        const GroundModel model = segmentGround(scan.cloud, GroundParams{});
        EXPECT_GE(groundFound(scan, model, 40.0), 0.85) << "patches as wide as the ramp's foot cannot follow the fold";
    }
}

TEST(Ground, HeightsAreThoseAboveTheSurfaceAlsoWhereASensorIsTilted) {
    World world;
    world.ground = {{Eigen::Vector2d::Zero(), 0.0, -kInfinity, 6.0},
                    {Eigen::Vector2d(0.12, 0.0), -0.72, 6.0, kInfinity}};
    Sensor sensor = noisySensor();
    sensor.axes = Eigen::AngleAxisd(radians(18.0), Eigen::Vector3d::UnitX()).toRotationMatrix();
    const PointCloud cloud = castRays(world, sensor).cloud;
    const GroundModel model = segmentGround(cloud, GroundParams{});
    ASSERT_EQ(model.evidence, GroundEvidence::Good);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f& p = cloud.xyz[i];
        if (p.head<2>().norm() > 40.0f) continue;
        ASSERT_NEAR(model.height[i], p.z() - model.heightAt(p.x(), p.y()), 0.03) << p.transpose();
    }
}

TEST(Ground, ASourceWithoutRingsIsSegmentedAsWell) {
    Sensor sensor = noisySensor();
    sensor.rings = false;
    expectGroundFound(withTraffic(flatWorld()), sensor);
    expectGroundFound(withTraffic(tiltedWorld(4.0, -3.0)), sensor);
}

TEST(Ground, EightPlanesAreEnough) {
    Sensor sensor = noisySensor();
    sensor.planes = 8;
    sensor.step_deg = 4.0;
    expectGroundFound(withTraffic(flatWorld()), sensor);
    expectGroundFound(withTraffic(tiltedWorld(0.0, 5.0)), sensor);
}

TEST(Ground, TheSameCloudGivesTheSameGroundBitForBit) {
    const PointCloud cloud = castRays(withTraffic(tiltedWorld(2.0, 1.0)), noisySensor()).cloud;
    const GroundModel a = segmentGround(cloud, GroundParams{});
    const GroundModel b = segmentGround(cloud, GroundParams{});
    EXPECT_EQ(a.is_ground, b.is_ground);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.normal, b.normal);
    EXPECT_EQ(a.plane.slope, b.plane.slope);
    EXPECT_EQ(a.plane.offset, b.plane.offset);
    EXPECT_EQ(a.rise, b.rise);
}

TEST(Ground, ABadParameterIsRefused) {
    const PointCloud cloud = castRays(flatWorld(), Sensor{}).cloud;
    GroundParams params;
    params.iterations = 0;
    EXPECT_THROW(segmentGround(cloud, params), std::invalid_argument);
    params = GroundParams{};
    params.sectors = 0;
    EXPECT_THROW(segmentGround(cloud, params), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles
