// SPDX-License-Identifier: BSD-3-Clause
// Boxes from any mapper's grid (Sec. III, Fig. 2).
#include <gtest/gtest.h>

#include <stdexcept>

#include "lidar_obstacles/grid_image.h"
#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/pipelines.h"
#include "support/pipeline_scene.h"
#include "support/size_model.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// A mapper of its own: each cell under a car's outline is occupied, drawn from the known boxes and not from returns.
OccupancyGrid drawnGrid(const World& world, const Eigen::Vector2d& origin, double resolution, int objects) {
    const auto cells = [&](double extent) { return static_cast<int>(std::ceil(extent / resolution)); };
    cv::Mat1b states(cells(2.0 * -origin.y()), cells(2.0 * -origin.x()), static_cast<std::uint8_t>(CellState::Free));
    for (int row = 0; row < states.rows; ++row)
        for (int col = 0; col < states.cols; ++col)
            for (int k = 0; k < objects; ++k)
                if (distanceTo(world.boxes[k], (origin + resolution * Eigen::Vector2d(col + 0.5, row + 0.5)).eval()) <
                    0.71 * resolution)
                    states(row, col) = static_cast<std::uint8_t>(CellState::Occupied);
    return gridOf(states, origin, resolution);
}

/// Detects on a drawn grid and expects a box on each car that is seen well.
void expectCarsOnGrid(const Eigen::Vector2d& origin, double resolution) {
    const World world = street();
    const Scan scan = streetScan();
    const DetectionResult r = detectOnGrid(drawnGrid(world, origin, resolution, 6), scan.cloud,
                                           segmentGround(scan.cloud, GroundParams{}), bySize());
    for (const int car : {0, 1, 2, 3}) {
        const Obstacle* o = obstacleOn(scan, r.obstacles, car);
        ASSERT_NE(o, nullptr) << "car " << car;
        const double range = distanceTo(world.boxes[car], Eigen::Vector2d::Zero());
        EXPECT_NEAR(distanceTo(o->box, Eigen::Vector2d::Zero()), range, 0.08 + range * radians(0.2)) << "car " << car;
        EXPECT_LE(headingError(o->box.yaw, world.boxes[car].yaw), 4.0) << "car " << car;
    }
    const auto drawn = std::count_if(r.obstacles.begin(), r.obstacles.end(),
                                     [](const Obstacle& o) { return o.cls != ObstacleClass::Structure; });
    EXPECT_LE(drawn, 6) << "nothing but the cars is drawn";
}

TEST(DetectOnGrid, AGridMadeFromBoxesGivesTheirBoxes) { expectCarsOnGrid({-60.0, -40.0}, 0.2); }

TEST(DetectOnGrid, AGridOfAnotherResolutionAndOriginGivesThemAsWell) {
    expectCarsOnGrid({-31.37, -15.11}, 0.25);
    expectCarsOnGrid({-47.9, -23.45}, 0.1);
}

TEST(DetectOnGrid, OnItsOwnGridThePipelineFindsTheSame) {
    const Scan scan = streetScan();
    for (const Algorithm algorithm : {Algorithm::Planes16, Algorithm::Planes8, Algorithm::Auto}) {
        const DetectorParams params = withAlgorithm(algorithm);
        const DetectionResult r = detect(scan.cloud, params);
        expectSame(detectOnGrid(r.grid, scan.cloud, r.ground, params).obstacles, r.obstacles);
    }
}

TEST(DetectOnGrid, UnderASensorUpsideDownItFindsTheSame) {
    const PointCloud hanging = upsideDown(streetScan().cloud);
    const DetectionResult r = detect(hanging, bySize());
    const GroundModel ground = segmentGround(hanging, GroundParams{});
    EXPECT_EQ(ground.is_ground, r.ground.is_ground);
    expectSame(detectOnGrid(r.grid, hanging, ground, bySize()).obstacles, r.obstacles);
}

TEST(DetectOnGrid, AGridWithoutOccupiedCellsOrWithoutCellsHasNoneOnIt) {
    const Scan scan = streetScan();
    const GroundModel ground = segmentGround(scan.cloud, GroundParams{});
    OccupancyGrid none;
    none.resolution = 0.2;
    for (const OccupancyGrid& grid : {drawnGrid(street(), {-40, -40}, 0.2, 0), none}) {
        const DetectionResult r = detectOnGrid(grid, scan.cloud, ground, {});
        EXPECT_TRUE(r.pieces.empty());
        EXPECT_TRUE(r.clusters.accepted.empty());
        for (const Obstacle& o : r.obstacles)  // the walls above the region, of which the grid says nothing
            for (const std::int32_t i : o.points) ASSERT_GT(ground.height[i], RegionParams{}.max_height);
        DetectorParams bare;
        bare.pipeline.bare_paper = true;
        EXPECT_TRUE(detectOnGrid(grid, scan.cloud, ground, bare).obstacles.empty());
    }
}

TEST(DetectOnGrid, CellsThatAreNotThoseOfAGridAreRefused) {
    const test::Scan scan = castRays(street(), test::Sensor{});
    const GroundModel ground = segmentGround(scan.cloud, {});
    const OccupancyGrid good = drawnGrid(street(), {-40, -40}, 0.2, 6);
    ASSERT_GT(good.occupied.size(), 2u);
    OccupancyGrid unsorted = good, outside = good, none = good;
    std::swap(unsorted.occupied.front(), unsorted.occupied.back());
    outside.occupied.back() = good.width * good.height;
    none.width = 0;
    for (const OccupancyGrid* grid : {&unsorted, &outside, &none})
        EXPECT_THROW(detectOnGrid(*grid, scan.cloud, ground, {}), std::invalid_argument);
}

TEST(DetectOnGrid, ACloudWithoutRingsIsServedAsWell) {
    Sensor sensor;
    sensor.rings = false;
    const Scan scan = castRays(street(), sensor);
    const GroundModel ground = segmentGround(scan.cloud, GroundParams{});
    const DetectionResult r = detectOnGrid(drawnGrid(street(), {-40, -40}, 0.2, 6), scan.cloud, ground, bySize());
    for (const int car : {0, 2, 3}) EXPECT_NE(obstacleOn(scan, r.obstacles, car), nullptr) << "car " << car;
}

TEST(DetectOnGrid, OccupiedCellsWithoutReturnsGiveNoBox) {
    const OccupancyGrid grid = drawnGrid(street(), {-40, -40}, 0.2, 6);
    EXPECT_TRUE(detectOnGrid(grid, PointCloud{}, GroundModel{}, {}).obstacles.empty());
}

TEST(DetectOnGrid, AGroundOfAnotherCloudIsRefused) {
    const Scan scan = castRays(street(), Sensor{});
    const DetectionResult r = detect(scan.cloud, withAlgorithm(Algorithm::Planes16));
    EXPECT_THROW(detectOnGrid(r.grid, scan.cloud, GroundModel{}, DetectorParams{}), std::invalid_argument);
}

TEST(DetectOnGrid, APartOfALargerImageServesAsGrid) {
    const Scan scan = castRays(street(), Sensor{});
    const DetectionResult r = detect(scan.cloud, withAlgorithm(Algorithm::Planes16));
    cv::Mat1b larger = cv::Mat1b::zeros(r.grid.height + 8, r.grid.width + 8);
    cv::Mat1b part = larger(cv::Rect(4, 4, r.grid.width, r.grid.height));
    stateImage(r.grid).copyTo(part);
    expectSame(detectOnGrid(gridOf(part, r.grid.origin, r.grid.resolution), scan.cloud, r.ground,
                            withAlgorithm(Algorithm::Planes16))
                   .obstacles,
               r.obstacles);
}

TEST(DetectOnGrid, ABadParameterIsRefused) {
    DetectorParams params;
    params.grid.resolution = -0.2;
    EXPECT_THROW(detectOnGrid(OccupancyGrid{}, PointCloud{}, GroundModel{}, params), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles
