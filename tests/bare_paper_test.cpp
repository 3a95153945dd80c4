// SPDX-License-Identifier: BSD-3-Clause
// The paper by itself: what is left when everything that it does not have is switched off.
#include <gtest/gtest.h>

#include <set>
#include <stdexcept>
#include <string>

#include "lidar_obstacles/pipelines.h"
#include "support/pipeline_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

DetectorParams bare(Algorithm algorithm = Algorithm::Planes16) {
    DetectorParams params = withAlgorithm(algorithm);
    params.pipeline.bare_paper = true;
    return params;
}

TEST(BarePaper, SwitchesOffWhatThePaperDoesNotHaveAndNothingElse) {
    const DetectorParams p = barePaper(DetectorParams{});
    EXPECT_TRUE(p.pipeline.bare_paper);
    EXPECT_EQ(p.plane_fit.method, BoxMethod::Plane);
    EXPECT_EQ(p.box.completion, Completion::None);
    EXPECT_EQ(p.clustering.link_columns, 0);
    EXPECT_FALSE(p.hull_fit.refine);
    EXPECT_FALSE(p.ground.standing_runs);
    EXPECT_EQ(p.grid.resolution, GridParams{}.resolution);
    EXPECT_EQ(p.gates.max_length, GateParams{}.max_length);
    EXPECT_EQ(p.pipeline.algorithm, PipelineParams{}.algorithm);
    EXPECT_NO_THROW(validate(p));
}

TEST(BarePaper, CarsAndPeopleOfAStreetAreFoundWhereTheyAre) {
    const Scan scan = streetScan();
    const World world = street();
    const DetectionResult r = detect(scan.cloud, bare());
    for (const int k : {0, 2, 3, 6}) {
        const Obstacle* o = obstacleOn(scan, r.obstacles, k);
        ASSERT_NE(o, nullptr) << "object " << k;
        const double range = distanceTo(world.boxes[k], Eigen::Vector2d::Zero());
        // noise of 2 cm, of which the nearest return takes three; a column's width
        EXPECT_NEAR(distanceTo(o->box, Eigen::Vector2d::Zero()), range, 0.08 + range * radians(0.2)) << "object " << k;
        EXPECT_EQ(o->cls, k < 6 ? ObstacleClass::Vehicle : ObstacleClass::Pedestrian) << "object " << k;
    }
}

TEST(BarePaper, WallsAreTooLargeAndNoObstacle) {
    for (const Algorithm algorithm : {Algorithm::Planes16, Algorithm::Planes8}) {
        const Scan scan = streetScan();
        const DetectionResult r = detect(scan.cloud, bare(algorithm));
        EXPECT_TRUE(r.clusters.structure.empty());
        bool too_large = false;
        for (const RejectedCluster& c : r.clusters.rejected) too_large |= c.reason == RejectReason::TooLarge;
        EXPECT_TRUE(too_large);
        for (const Obstacle& o : r.obstacles) EXPECT_NE(o.cls, ObstacleClass::Structure);
    }
}

TEST(BarePaper, BoxesEncloseWhatIsSeen) {
    for (const Algorithm algorithm : {Algorithm::Planes16, Algorithm::Planes8, Algorithm::Auto}) {
        const Scan scan = streetScan();
        const DetectionResult r = detect(scan.cloud, bare(algorithm));
        ASSERT_FALSE(r.obstacles.empty());
        for (const Obstacle& o : r.obstacles) {
            EXPECT_EQ(o.box.size, o.seen_box.size);
            EXPECT_EQ(o.box.center, o.seen_box.center);
        }
    }
}

TEST(BarePaper, NothingIsWeighedAndNoModelIsRead) {
    DetectorParams params = bare();
    params.recognizer.model = "/nonexistent/model.txt";
    const DetectionResult r = detect(streetScan().cloud, params);
    EXPECT_TRUE(r.hypotheses.empty());
    EXPECT_FALSE(r.pieces.empty());
    std::set<std::string> stages;
    for (const StageTime& t : r.timing) stages.insert(t.stage);
    EXPECT_EQ(stages, (std::set<std::string>{"ground", "region", "grid", "pieces", "groups", "boxes", "completion",
                                             "structure"}));
    params.pipeline.bare_paper = false;
    EXPECT_THROW(detect(streetScan().cloud, params), std::runtime_error);
}

TEST(BarePaper, LimitsByClassAreNoneOfThePaper) {
    const PointCloud cloud = streetScan().cloud;
    DetectorParams strict = barePaper({});
    const DetectionResult usual = detect(cloud, strict);
    strict.gates.min_points_vehicle = 1000;
    strict.gates.max_length_vehicle = 0.1;
    strict.gates.min_probability = 1.0;
    const DetectionResult r = detect(cloud, strict);
    ASSERT_EQ(r.obstacles.size(), usual.obstacles.size());
    for (std::size_t k = 0; k < r.obstacles.size(); ++k) EXPECT_EQ(r.obstacles[k].cls, usual.obstacles[k].cls);
}

TEST(BarePaper, EveryPieceIsAcceptedOrRejectedOnce) {
    const DetectionResult r = detect(streetScan().cloud, bare());
    std::multiset<std::vector<std::int32_t>> pieces;
    std::multiset<std::vector<std::int32_t>> sorted;
    for (const Cluster& c : r.pieces) pieces.insert(c.points);
    for (const Cluster& c : r.clusters.accepted) sorted.insert(c.points);
    for (const RejectedCluster& c : r.clusters.rejected) sorted.insert(c.cluster.points);
    EXPECT_EQ(pieces, sorted);
    EXPECT_EQ(r.obstacles.size(), r.clusters.accepted.size());
}

TEST(BarePaper, ACloudWithoutRingsStaysWithoutThem) {
    Sensor sensor;
    sensor.rings = false;
    const Scan scan = castRays(street(), sensor);
    const DetectionResult r = detect(scan.cloud, bare());
    for (const int car : {0, 2, 3}) {
        const Obstacle* o = obstacleOn(scan, r.obstacles, car);
        ASSERT_NE(o, nullptr) << "car " << car;
        EXPECT_EQ(o->num_rings, 0);
    }
}

TEST(BarePaper, AnEmptyCloudAndReturnsThatAreNoNumbersAreServedAsElsewhere) {
    EXPECT_TRUE(detect(PointCloud{}, bare()).obstacles.empty());
    EXPECT_THROW(detect(cloudOf({{std::nanf(""), 0.0f, 1.0f}}), bare()), std::invalid_argument);
}

TEST(BarePaper, OnItsOwnGridItFindsTheSame) {
    const Scan scan = streetScan();
    const DetectionResult r = detect(scan.cloud, bare());
    expectSame(detectOnGrid(r.grid, scan.cloud, r.ground, bare()).obstacles, r.obstacles);
}

}  // namespace
}  // namespace lidar_obstacles
