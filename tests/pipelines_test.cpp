// SPDX-License-Identifier: BSD-3-Clause
// The 16-plane pipeline from cloud to obstacles.
#include "lidar_obstacles/pipelines.h"
#include "lidar_obstacles/grid_image.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <string>

#include "lidar_obstacles/classification.h"
#include "support/pipeline_scene.h"
#include "support/size_model.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// The 16-plane algorithm with classes by size.
DetectionResult runBySize(const PointCloud& cloud) { return detect(cloud, bySize(withAlgorithm(Algorithm::Planes16))); }

TEST(Detect16Plane, AnEmptyCloudHasNoObstacles) {
    const DetectionResult r = detect(PointCloud{}, withAlgorithm(Algorithm::Planes16));
    EXPECT_EQ(r.ground.evidence, GroundEvidence::None);
    EXPECT_TRUE(r.candidates.empty());
    EXPECT_TRUE(r.obstacles.empty());
    EXPECT_TRUE(r.clusters.accepted.empty());
    EXPECT_TRUE(r.clusters.rejected.empty());
    EXPECT_EQ(cv::countNonZero(stateImage(r.grid)), 0);
}

TEST(Detect16Plane, OneReturnIsRejectedWithItsReason) {
    const DetectionResult r = detect(cloudOf({{25.0f, 0.0f, 1.0f}}), withAlgorithm(Algorithm::Planes16));
    EXPECT_TRUE(r.obstacles.empty());
    ASSERT_EQ(r.clusters.rejected.size(), 1u);
    EXPECT_EQ(r.clusters.rejected[0].reason, RejectReason::TooFewPoints);
}

TEST(Detect16Plane, CarsAndPeopleOfAStreetAreFoundWhereTheyAre) {
    const Scan scan = streetScan();
    const DetectionResult r = runBySize(scan.cloud);
    const World world = street();
    for (int k = 0; k < 8; ++k) {
        const OrientedBox& truth = world.boxes[k];
        if (scan.returnsOn(k).size() < 15) continue;
        const Obstacle* o = obstacleOn(scan, r.obstacles, k);
        ASSERT_NE(o, nullptr) << "object " << k;
        const double range = distanceTo(truth, Eigen::Vector2d::Zero());
        // noise of 2 cm, of which the nearest return takes three; a column's width
        EXPECT_NEAR(distanceTo(o->box, Eigen::Vector2d::Zero()), range, 0.08 + range * radians(0.2)) << "object " << k;
        EXPECT_EQ(o->cls, k < 6 ? ObstacleClass::Vehicle : ObstacleClass::Pedestrian) << "object " << k;
        EXPECT_LE(k < 6 ? headingError(o->box.yaw, truth.yaw) : 0.0, 4.0) << "object " << k;
    }
}

TEST(Detect16Plane, WallsAreStructureInPiecesAndNothingOfThemIsLost) {
    const Scan scan = streetScan();
    const DetectionResult r = runBySize(scan.cloud);
    std::set<std::int32_t> in_boxes;
    for (const Obstacle& o : r.obstacles) {
        if (o.cls != ObstacleClass::Structure) continue;
        EXPECT_LE(o.box.size.x(), 6.0 + 0.05);
        EXPECT_FALSE(o.heading_valid);
        in_boxes.insert(o.points.begin(), o.points.end());
    }
    std::size_t wall = 0;
    std::size_t found = 0;
    for (const std::int32_t i : r.candidates) {
        wall += scan.hit[i] >= 8;
        found += scan.hit[i] >= 8 && in_boxes.count(i) == 1;
    }
    EXPECT_GT(wall, 1000u);
    EXPECT_GE(found, wall * 98 / 100) << "but for pieces of a return or two at the far ends";
}

TEST(Detect16Plane, OutputsAreFiniteAndAnglesAreInRange) {
    for (const World& world : {street(), tiltedWorld(5.0, 0.0), World{}}) {
        const DetectionResult r = detect(castRays(world, Sensor{}).cloud, withAlgorithm(Algorithm::Planes16));
        EXPECT_TRUE(r.ground.normal.allFinite());
        for (const float h : r.ground.height) ASSERT_TRUE(std::isfinite(h));
        for (const Obstacle& o : r.obstacles) {
            EXPECT_TRUE(isFinite(o.box));
            EXPECT_TRUE(std::isfinite(o.heading_std));
            EXPECT_GT(o.box.size.minCoeff(), 0.0);
            EXPECT_GE(o.box.yaw, -M_PI);
            EXPECT_LT(o.box.yaw, M_PI);
        }
    }
}

TEST(Detect16Plane, ReturnsThatAreNoNumbersDoNotReachTheBoxes) {
    // the border drops them; a caller of his own may forget to
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e30f}) {
        Scan scan = streetScan();
        for (std::size_t i = 0; i < scan.cloud.size(); i += 97) scan.cloud.xyz[i] = {value, value, value};
        try {
            for (const Obstacle& o : detect(scan.cloud, withAlgorithm(Algorithm::Planes16)).obstacles)
                EXPECT_TRUE(isFinite(o.box));
        } catch (const std::invalid_argument&) {  // as good an answer
        }
    }
}

TEST(Detect16Plane, ObstaclesAreNumberedNearestFirst) {
    const Scan scan = streetScan();
    const auto obstacles = runBySize(scan.cloud).obstacles;
    ASSERT_GE(obstacles.size(), 5u);
    double last = 0.0;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        EXPECT_EQ(obstacles[k].id, static_cast<int>(k));
        const double range = obstacles[k].box.center.head<2>().norm();
        EXPECT_GE(range, last);
        last = range;
    }
}

TEST(Detect16Plane, EveryStageHasATime) {
    const DetectionResult r = detect(streetScan().cloud, withAlgorithm(Algorithm::Planes16));
    std::set<std::string> stages;
    for (const StageTime& t : r.timing) {
        EXPECT_GE(t.ms, 0.0);
        EXPECT_TRUE(stages.insert(t.stage).second) << t.stage << " twice";
    }
    for (const char* stage :
         {"ground", "region", "grid", "pieces", "tree", "score", "groups", "above", "boxes", "structure"})
        EXPECT_EQ(stages.count(stage), 1u) << stage;
}

TEST(Detect16Plane, TheSameCloudGivesTheSameObstaclesBitForBit) {
    const Scan scan = streetScan();
    expectSame(detect(scan.cloud, withAlgorithm(Algorithm::Planes16)).obstacles,
               detect(scan.cloud, withAlgorithm(Algorithm::Planes16)).obstacles);
}

TEST(Detect16Plane, ACarOnASlopeStandsOnIt) {
    World world = tiltedWorld(5.0, 0.0);
    world.boxes = {standOn(world, carAt(14.0, 2.0, 10.0))};
    const Scan scan = castRays(world, Sensor{});
    const DetectionResult r = runBySize(scan.cloud);
    const Obstacle* o = obstacleOn(scan, r.obstacles, 0);
    ASSERT_NE(o, nullptr);
    const double ground = world.ground[0].heightAt(o->box.center.x(), o->box.center.y());
    EXPECT_NEAR(o->box.center.z() - 0.5 * o->box.size.z(), ground, 0.15);
    EXPECT_EQ(o->cls, ObstacleClass::Vehicle);
}

TEST(Detect16Plane, ARampAheadIsNoObstacle) {
    for (const double slope_deg : {-5.0, 3.0, 5.0}) {
        World world = flatWorld();
        world.ground[0].x_max = 12.0;
        GroundStrip ramp;
        ramp.slope.x() = std::tan(radians(slope_deg));
        ramp.offset = -12.0 * ramp.slope.x();
        ramp.x_min = 12.0;
        world.ground.push_back(ramp);
        Sensor sensor;
        sensor.noise = 0.02;
        const DetectionResult r = detect(castRays(world, sensor).cloud, withAlgorithm(Algorithm::Planes16));
        // a sector that the fold runs through lengthwise has one plane for both sides: low strips may stand out beyond
        // 30 m
        for (const Obstacle& o : r.obstacles)
            EXPECT_GT(o.box.center.head<2>().norm(), 30.0) << "an obstacle at " << slope_deg << " deg";
    }
}

TEST(Detect16Plane, EmptyRoadsOfAllSlopesHaveNoObstacles) {
    Sensor sensor;
    sensor.noise = 0.02;
    for (const double pitch : {-5.0, 0.0, 5.0})
        for (const double bank : {-3.0, 0.0, 3.0}) {
            const Scan scan = castRays(tiltedWorld(pitch, bank), sensor);
            EXPECT_TRUE(detect(scan.cloud, withAlgorithm(Algorithm::Planes16)).obstacles.empty())
                << pitch << ", " << bank;
        }
}

TEST(Detect16Plane, ASensorAwayFromTheOriginSeesTheSameCars) {
    Sensor sensor;
    sensor.position = {1.4, -0.3, 1.7};
    sensor.noise = 0.02;
    const Scan scan = castRays(street(), sensor);
    const DetectionResult r = runBySize(scan.cloud);
    for (const int car : {0, 2, 3}) {
        const Obstacle* o = obstacleOn(scan, r.obstacles, car);
        ASSERT_NE(o, nullptr) << "car " << car;
        EXPECT_LE(headingError(o->box.yaw, street().boxes[car].yaw), 4.0) << "car " << car;
        EXPECT_NEAR(distanceTo(o->box, sensor.position.head<2>()),
                    distanceTo(street().boxes[car], sensor.position.head<2>()), 0.15)
            << "car " << car;
    }
}

/// Distance from the nearest face of each car of the street that has 100 returns to where it is found [m]; 99: not
/// found.
double worstDistance(const Scan& scan) {
    const auto obstacles = runBySize(scan.cloud).obstacles;
    const World world = street();
    double worst = 0.0;
    for (int k = 0; k < 6; ++k) {
        if (scan.returnsOn(k).size() < 100) continue;
        const Obstacle* o = obstacleOn(scan, obstacles, k);
        if (!o) return 99.0;
        worst =
            std::max(worst, std::abs(distanceTo(o->box, Eigen::Vector2d::Zero()) -
                                     distanceTo(world.boxes[static_cast<std::size_t>(k)], Eigen::Vector2d::Zero())));
    }
    return worst;
}

TEST(Detect16Plane, TiltedSensorsOfThirtyTwoPlanesSeeTheSameCars) {
    Sensor sensor;
    sensor.planes = 32;
    sensor.lowest_deg = -92.0 / 3.0;
    sensor.step_deg = 4.0 / 3.0;
    for (const bool rings : {true, false})
        for (const double pitch : {0.0, 8.0, 15.0, 25.0, 40.0})
            for (const double roll : {0.0, 10.0, 180.0}) {
                SCOPED_TRACE(std::to_string(pitch) + ", " + std::to_string(roll) + (rings ? "" : " without rings"));
                sensor.rings = rings;
                sensor.axes = (Eigen::AngleAxisd(radians(pitch), Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(radians(roll), Eigen::Vector3d::UnitX()))
                                  .toRotationMatrix();
                EXPECT_LT(worstDistance(castRays(street(), sensor)), 0.3);
            }
}

TEST(Detect16Plane, ACloudWithoutRingsIsServedAsWell) {
    Sensor sensor;
    sensor.rings = false;
    const Scan scan = castRays(street(), sensor);
    const DetectionResult r = runBySize(scan.cloud);
    for (const int car : {0, 2, 3}) EXPECT_NE(obstacleOn(scan, r.obstacles, car), nullptr) << "car " << car;
}

TEST(Detect16Plane, ABadParameterIsNamed) {
    DetectorParams params;
    params.grid.resolution = -0.2;
    try {
        detect(PointCloud{}, withAlgorithm(Algorithm::Planes16, params));
        FAIL() << "accepted";
    } catch (const std::invalid_argument& e) {
        EXPECT_NE(std::string(e.what()).find("[grid] resolution = -0.2"), std::string::npos) << e.what();
    }
}

TEST(Detect16Plane, APersonHasNoHeading) {
    World world = flatWorld();
    world.boxes = {personAt(8.0, 1.0)};
    const DetectionResult r = runBySize(castRays(world, Sensor{}).cloud);
    ASSERT_EQ(r.obstacles.size(), 1U);
    EXPECT_EQ(r.obstacles[0].cls, ObstacleClass::Pedestrian);
    EXPECT_FALSE(r.obstacles[0].heading_valid);
}

}  // namespace
}  // namespace lidar_obstacles
