// SPDX-License-Identifier: BSD-3-Clause
// The 8-plane pipeline and the choice between both (Sec. IV), from cloud to obstacles.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "lidar_obstacles/pipelines.h"
#include "support/pipeline_scene.h"
#include "support/size_model.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// The facts that hold for either, with classes by size.
class FewPlanes : public testing::TestWithParam<Algorithm> {
  protected:
    static DetectionResult run(const PointCloud& cloud, const DetectorParams& params = {}) {
        return detect(cloud, bySize(withAlgorithm(GetParam(), params)));
    }
};

std::string nameOf(const testing::TestParamInfo<Algorithm>& info) {
    return info.param == Algorithm::Planes8 ? "Detect8Plane" : "DetectAuto";
}

INSTANTIATE_TEST_SUITE_P(Pipelines, FewPlanes, testing::Values(Algorithm::Planes8, Algorithm::Auto), nameOf);

TEST_P(FewPlanes, AnEmptyCloudHasNoObstacles) {
    const DetectionResult r = run(PointCloud{});
    EXPECT_TRUE(r.obstacles.empty());
    EXPECT_TRUE(r.clusters.accepted.empty());
    EXPECT_TRUE(r.clusters.rejected.empty());
    EXPECT_TRUE(r.grid.occupied.empty());
}

TEST_P(FewPlanes, OneReturnIsRejectedWithItsReason) {
    const DetectionResult r = run(cloudOf({{25.0f, 0.0f, 1.0f}}));
    EXPECT_TRUE(r.obstacles.empty());
    ASSERT_EQ(r.clusters.rejected.size(), 1u);
    EXPECT_EQ(r.clusters.rejected[0].reason, RejectReason::TooFewPoints);
}

TEST_P(FewPlanes, CarsAndPeopleOfAStreetAreFoundWhereTheyAre) {
    const World world = street();
    for (const int planes : {16, 8, 4}) {
        const Scan scan = streetScan(planes);
        const DetectionResult r = run(scan.cloud);
        for (int k = 0; k < 8; ++k) {
            SCOPED_TRACE("object " + std::to_string(k) + " by " + std::to_string(planes) + " planes");
            const OrientedBox& truth = world.boxes[k];
            if (scan.returnsOn(k).size() < 15) continue;
            const Obstacle* o = obstacleOn(scan, r.obstacles, k);
            ASSERT_NE(o, nullptr);
            const double range = distanceTo(truth, Eigen::Vector2d::Zero());
            // noise of 2 cm, of which the nearest return takes three; a column's width; a cell that turns the face
            EXPECT_NEAR(distanceTo(o->box, Eigen::Vector2d::Zero()), range, 0.08 + range * radians(0.2) + 0.05);
            EXPECT_EQ(o->heading_valid, k < 6);
            // a cell over the rear, and the noise of the range on top: 4 deg as the 16-plane algorithm is held to
            EXPECT_LE(k < 6 ? headingError(o->box.yaw, truth.yaw) : 0.0, 4.0);
        }
    }
}

TEST_P(FewPlanes, TheGridIsFineAndEveryClusterKnowsItsCells) {
    const Scan scan = streetScan(8);
    const DetectionResult r = run(scan.cloud);
    EXPECT_EQ(r.grid.resolution, GridParams{}.fine_resolution);
    ASSERT_FALSE(r.clusters.accepted.empty());
    for (const Cluster& c : r.clusters.accepted) {
        EXPECT_FALSE(c.cells.empty());
        EXPECT_LE(c.cells.size(), c.points.size());
    }
}

TEST_P(FewPlanes, OutputsAreFiniteAndExplained) {
    for (const int planes : {8, 4, 1})
        for (const World& world : {street(), tiltedWorld(5.0, 0.0), World{}}) {
            const Scan scan = castRays(world, fewPlanes(planes));
            for (const Obstacle& o : run(scan.cloud).obstacles) {
                EXPECT_TRUE(isFinite(o.box));
                EXPECT_TRUE(isFinite(o.seen_box));
                EXPECT_GT(o.box.size.minCoeff(), 0.0);
                EXPECT_GE(o.box.yaw, -M_PI);
                EXPECT_LT(o.box.yaw, M_PI);
                EXPECT_EQ(o.heading_valid, o.rule != HeadingRule::None);
                EXPECT_GE(o.max_height, o.box.size.z());
                EXPECT_GE(o.num_rings, 1);
                EXPECT_LE(o.num_rings, planes);
                for (const Eigen::Vector2d& m : o.marks) EXPECT_TRUE(m.allFinite());
                for (const Eigen::Vector2d& c : o.hull) EXPECT_TRUE(c.allFinite());
            }
        }
}

TEST_P(FewPlanes, ObstaclesAreNumberedNearestFirst) {
    const auto obstacles = run(streetScan(8).cloud).obstacles;
    ASSERT_GE(obstacles.size(), 5u);
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        EXPECT_EQ(obstacles[k].id, static_cast<int>(k));
        const auto range = [&](std::size_t i) { return obstacles[i].box.center.head<2>().norm(); };
        EXPECT_TRUE(k == 0 || range(k - 1) <= range(k));
    }
}

TEST_P(FewPlanes, EveryStageHasATime) {
    std::set<std::string> stages;
    for (const StageTime& t : run(streetScan(8).cloud).timing)
        EXPECT_TRUE(stages.insert(t.stage).second) << t.stage << " twice";
    for (const char* stage :
         {"ground", "region", "grid", "pieces", "tree", "score", "groups", "above", "boxes", "completion", "structure"})
        EXPECT_EQ(stages.count(stage), 1u) << stage;
}

TEST_P(FewPlanes, TheSameCloudGivesTheSameObstaclesBitForBit) {
    const Scan scan = streetScan(8);
    expectSame(run(scan.cloud).obstacles, run(scan.cloud).obstacles);
}

TEST_P(FewPlanes, ACloudWithoutRingsIsServedAsWell) {
    Sensor sensor = fewPlanes(8);
    sensor.rings = false;
    const Scan scan = castRays(street(), sensor);
    const auto obstacles = run(scan.cloud).obstacles;
    for (const int car : {0, 2, 3}) EXPECT_NE(obstacleOn(scan, obstacles, car), nullptr) << "car " << car;
}

TEST_P(FewPlanes, ASensorAwayFromTheOriginSeesTheSameCars) {
    Sensor sensor = fewPlanes(8);
    sensor.position = {1.4, -0.3, 1.7};
    const Scan scan = castRays(street(), sensor);
    const DetectionResult r = run(scan.cloud);
    for (const int car : {0, 2, 3}) {
        const Obstacle* o = obstacleOn(scan, r.obstacles, car);
        ASSERT_NE(o, nullptr) << "car " << car;
        EXPECT_LE(headingError(o->box.yaw, street().boxes[car].yaw), 4.0) << "car " << car;
    }
}

TEST_P(FewPlanes, BadInputIsRefused) {
    DetectorParams params;
    params.grid.fine_resolution = 0.0;
    try {
        run(PointCloud{}, params);
        FAIL() << "accepted";
    } catch (const std::invalid_argument& e) {
        EXPECT_NE(std::string(e.what()).find("[grid] fine_resolution"), std::string::npos) << e.what();
    }
    EXPECT_THROW(run(cloudOf({{std::nanf(""), 0.0f, 1.0f}})), std::invalid_argument);
}

TEST(Detect8Plane, HeadingsComeFromHulls) {
    const auto obstacles = detect(streetScan(8).cloud, bySize(withAlgorithm(Algorithm::Planes8))).obstacles;
    std::set<HeadingRule> rules;
    for (const Obstacle& o : obstacles) rules.insert(o.rule);
    EXPECT_EQ(rules.count(HeadingRule::Plane), 0u);
    EXPECT_EQ(rules.count(HeadingRule::TwoSides), 1u);
    EXPECT_EQ(rules.count(HeadingRule::Line), 1u);
}

TEST(Detect8Plane, OnePlaneFindsACarAndItsHeading) {
    World world = flatWorld();
    world.boxes = {carAt(9.0, 2.0, 30.0)};
    const Scan scan = castRays(world, fewPlanes(1));
    const auto obstacles = detect(scan.cloud, bySize(withAlgorithm(Algorithm::Planes8))).obstacles;
    const Obstacle* o = obstacleOn(scan, obstacles, 0);
    ASSERT_NE(o, nullptr);
    EXPECT_EQ(o->rule, HeadingRule::TwoSides);
    EXPECT_LE(headingError(o->box.yaw, world.boxes[0].yaw), 1.0);
    EXPECT_EQ(o->num_rings, 1);
    EXPECT_EQ(o->max_height, kInfinity);
}

/// The cluster that an obstacle was made from.
const Cluster& clusterBehind(const Obstacle& o, const DetectionResult& r) {
    for (const Cluster& c : r.clusters.accepted)
        if (c.points == o.points) return c;
    throw std::logic_error("an obstacle from no cluster");
}

TEST(DetectAuto, APlaneIsFittedToWhatEnoughPlanesHitOverEnoughHeight) {
    std::map<bool, int> fits;
    for (const int planes : {16, 8, 4, 1}) {
        const Scan scan = streetScan(planes);
        const DetectorParams params;
        const DetectionResult r = detect(scan.cloud, bySize(withAlgorithm(Algorithm::Auto, params)));
        for (const Obstacle& o : r.obstacles) {
            if (o.cls == ObstacleClass::Structure) continue;
            const Cluster& c = clusterBehind(o, r);
            const bool upright =
                c.top - c.bottom >= params.pipeline.auto_min_height && o.num_rings >= params.pipeline.auto_min_planes;
            ++fits[upright];
            EXPECT_TRUE(o.rule == HeadingRule::None || (o.rule == HeadingRule::Plane) == upright);
            EXPECT_EQ(o.hull.empty(), upright) << "only a hull fit has a hull";
        }
    }
    EXPECT_GT(fits[true], 5);
    EXPECT_GT(fits[false], 1);
}

TEST(DetectAuto, ItsLimitsAreParameters) {
    const Scan scan = streetScan();
    DetectorParams never;
    never.pipeline.auto_min_planes = 17;
    DetectorParams always;
    always.pipeline.auto_min_planes = 1;
    always.pipeline.auto_min_height = 0.0;
    expectSame(detect(scan.cloud, withAlgorithm(Algorithm::Auto, never)).obstacles,
               detect(scan.cloud, withAlgorithm(Algorithm::Planes8, never)).obstacles);
    for (const Obstacle& o : detect(scan.cloud, withAlgorithm(Algorithm::Auto, always)).obstacles)
        EXPECT_TRUE(o.hull.empty());
}

TEST(DetectAuto, WithoutRingsTheHeightAloneDecides) {
    Sensor sensor;
    sensor.rings = false;
    const Scan scan = castRays(street(), sensor);
    const DetectionResult r = detect(scan.cloud, bySize(withAlgorithm(Algorithm::Auto)));
    ASSERT_FALSE(r.obstacles.empty());
    for (const Obstacle& o : r.obstacles) {
        if (o.cls == ObstacleClass::Structure) continue;
        const Cluster& c = clusterBehind(o, r);
        EXPECT_EQ(o.hull.empty(), c.top - c.bottom >= PipelineParams{}.auto_min_height);
    }
}

TEST(Detect, RunsTheAlgorithmThatIsNamed) {
    const Scan scan = streetScan(8);
    const DetectionResult planes = detect(scan.cloud, withAlgorithm(Algorithm::Planes16));
    const DetectionResult hulls = detect(scan.cloud, withAlgorithm(Algorithm::Planes8));
    EXPECT_EQ(planes.grid.resolution, GridParams{}.resolution);
    EXPECT_EQ(hulls.grid.resolution, GridParams{}.fine_resolution);
    for (const Obstacle& o : planes.obstacles) EXPECT_TRUE(o.hull.empty());
    EXPECT_TRUE(
        std::any_of(hulls.obstacles.begin(), hulls.obstacles.end(), [](const Obstacle& o) { return !o.hull.empty(); }));
    EXPECT_EQ(PipelineParams{}.algorithm, Algorithm::Auto);
}

TEST(Detect, CompletionServesAllAlgorithms) {
    World world = flatWorld();
    world.boxes = {carAt(10.0, 0.0, 0.0)};
    const Scan scan = castRays(world, fewPlanes(8));
    for (const Algorithm algorithm : {Algorithm::Planes16, Algorithm::Planes8, Algorithm::Auto}) {
        DetectorParams params = bySize(withAlgorithm(algorithm));
        const auto grown = detect(scan.cloud, params).obstacles;
        params.box.completion = Completion::None;
        const auto seen = detect(scan.cloud, params).obstacles;
        ASSERT_EQ(grown.size(), 1u);
        ASSERT_EQ(seen.size(), 1u);
        EXPECT_NEAR(grown[0].box.size.x(), params.box.car_length, 1e-9);
        EXPECT_LT(seen[0].box.size.x(), 1.0) << "only the rear is seen";
        EXPECT_EQ(seen[0].box.size, seen[0].seen_box.size);
        EXPECT_EQ(grown[0].seen_box.size, seen[0].box.size);
        // the rear that either shows: 7.75 m, to a centimetre
        EXPECT_NEAR(distanceTo(grown[0].box, Eigen::Vector2d::Zero()), 7.75, 0.01);
        EXPECT_NEAR(distanceTo(seen[0].box, Eigen::Vector2d::Zero()), 7.75, 0.01);
    }
}

}  // namespace
}  // namespace lidar_obstacles
