// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/maps.h"
#include "lidar_obstacles/grid_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/pipelines.h"

namespace lidar_obstacles {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr double kMrptLimit = 0.0004;  // MRPT clamps probabilities here

/// A 7 x 4 grid of unknown cells with one occupied and one free cell, off-centre in both directions.
OccupancyGrid smallGrid(const Eigen::Vector2d& origin, double resolution) {
    cv::Mat1b states(4, 7, static_cast<std::uint8_t>(CellState::Unknown));
    states(1, 5) = static_cast<std::uint8_t>(CellState::Occupied);
    states(3, 0) = static_cast<std::uint8_t>(CellState::Free);
    return gridOf(states, origin, resolution);
}

bool sameCells(const cv::Mat1b& a, const cv::Mat1b& b) { return a.size() == b.size() && cv::countNonZero(a != b) == 0; }

TEST(Maps, OccupiedCellsHaveNoProbabilityOfBeingFree) {
    const auto map = toOccupancyGridMap(smallGrid({-1.0, 2.0}, 0.2));
    EXPECT_NEAR(map.getCell(5, 1), 0.0F, kMrptLimit);
    EXPECT_NEAR(map.getCell(0, 3), 1.0F, kMrptLimit);
    EXPECT_EQ(map.getCell(2, 2), 0.5F);
}

TEST(Maps, ACellIsFoundWhereItsCentreLies) {
    const auto grid = smallGrid({-1.0, 2.0}, 0.2);
    const auto map = toOccupancyGridMap(grid);
    const Eigen::Vector2d occupied = grid.cellCenter(5, 1);
    EXPECT_NEAR(occupied.x(), 0.1, 1e-9);  // -1.0 + 5.5 * 0.2
    EXPECT_NEAR(occupied.y(), 2.3, 1e-9);
    EXPECT_LT(map.getPos(0.1F, 2.3F), 0.01F);
    EXPECT_GT(map.getPos(-0.9F, 2.7F), 0.99F);
    EXPECT_NEAR(map.idx2x(5), 0.1F, 1e-6);
    EXPECT_NEAR(map.idx2y(1), 2.3F, 1e-6);
}

TEST(Maps, ACornerBetweenMultiplesOfTheResolutionStaysWhereItIs) {
    for (const double resolution : {0.05, 0.13, 0.2, 0.3, 0.35}) {
        const auto grid = smallGrid({-12.34, 5.67}, resolution);
        const auto map = toOccupancyGridMap(grid);
        ASSERT_EQ(map.getSizeX(), 7U) << resolution;
        ASSERT_EQ(map.getSizeY(), 4U) << resolution;
        EXPECT_FLOAT_EQ(map.getXMin(), -12.34F);
        EXPECT_FLOAT_EQ(map.getYMin(), 5.67F);
        EXPECT_NEAR(map.getXMax(), -12.34 + 7 * resolution, 1e-5);
        EXPECT_NEAR(map.getYMax(), 5.67 + 4 * resolution, 1e-5);
    }
}

TEST(Maps, AGridSurvivesTheWayThereAndBack) {
    cv::RNG random(7);
    cv::Mat1b states(300, 600);
    random.fill(states, cv::RNG::UNIFORM, 0, 3);
    const OccupancyGrid grid = gridOf(states, {-60.0, -30.0}, 0.2);
    const auto back = fromOccupancyGridMap(toOccupancyGridMap(grid));
    EXPECT_TRUE(sameCells(stateImage(back), states));
    EXPECT_NEAR((back.origin - grid.origin).norm(), 0.0, 1e-5);  // float
    EXPECT_NEAR(back.resolution, grid.resolution, 1e-7);
}

TEST(Maps, AGridWithoutCellsBecomesAMapWithoutCells) {
    const auto map = toOccupancyGridMap(OccupancyGrid{});
    EXPECT_EQ(map.getSizeX() * map.getSizeY(), 0U);
    EXPECT_TRUE(fromOccupancyGridMap(map).empty());
}

TEST(Maps, ThresholdsDecideTheStateOfAForeignCell) {
    COccupancyGridMap2D map;
    map.setSize(0, 1, 0, 1, 0.5F, 0.5F);
    map.setCell(0, 0, 1 - 0.70F);  // MRPT: probability of being free
    map.setCell(1, 0, 1 - 0.15F);
    map.setCell(0, 1, 1 - 0.40F);
    const auto state = stateImage(fromOccupancyGridMap(map));
    EXPECT_EQ(state(0, 0), static_cast<std::uint8_t>(CellState::Occupied));
    EXPECT_EQ(state(0, 1), static_cast<std::uint8_t>(CellState::Free));
    EXPECT_EQ(state(1, 0), static_cast<std::uint8_t>(CellState::Unknown));
    EXPECT_EQ(state(1, 1), static_cast<std::uint8_t>(CellState::Unknown));
    const auto strict = stateImage(fromOccupancyGridMap(map, {0.9, 0.05}));
    EXPECT_EQ(cv::countNonZero(strict), 0);  // all unknown
    const auto eager = stateImage(fromOccupancyGridMap(map, {0.35, 0.2}));
    EXPECT_EQ(eager(1, 0), static_cast<std::uint8_t>(CellState::Occupied));
}

TEST(Maps, ThresholdsInTheWrongOrderAreRefused) {
    const COccupancyGridMap2D map;
    EXPECT_THROW(fromOccupancyGridMap(map, {0.2, 0.8}), std::invalid_argument);
    EXPECT_THROW(fromOccupancyGridMap(map, {1.1, 0.2}), std::invalid_argument);
    EXPECT_THROW(fromOccupancyGridMap(map, {0.6, -0.1}), std::invalid_argument);
}

/// A flat ground around the sensor and the rear of a car, 1.8 m wide and 1.5 m high, 10 m ahead: 16 planes' worth.
PointCloud carAhead() {
    PointCloud cloud;
    cloud.sensor_origin = {0.F, 0.F, 1.8F};
    for (float range = 4.F; range < 25.F; range *= 1.15F) {
        for (int k = 0; k < 900; ++k) {
            const float a = static_cast<float>(k) * 0.4F * static_cast<float>(M_PI) / 180.F;
            const Eigen::Vector3f p(range * std::cos(a), range * std::sin(a), 0.F);
            if (p.x() > 10.F && std::abs(p.y()) < 0.9F * p.x() / 10.F) continue;  // in the car's shadow
            cloud.xyz.push_back(p);
        }
    }
    for (float z = 0.3F; z <= 1.5F; z += 0.3F) {
        for (float y = -0.9F; y <= 0.9F; y += 0.05F) cloud.xyz.emplace_back(10.F, y, z);
    }
    return cloud;
}

TEST(Maps, BoxesAreFoundOnAGridBuiltByAnotherRoute) {
    const PointCloud cloud = carAhead();
    COccupancyGridMap2D map;
    map.setSize(-30, 30, -30, 30, 0.25F, 0.5F);
    for (float y = -0.9F; y <= 0.9F; y += 0.05F) map.setCell(map.x2idx(10.F), map.y2idx(y), 0.1F);
    const DetectorParams params;
    for (const bool with_ground : {false, true}) {
        std::optional<GroundModel> ground;
        if (with_ground) ground = segmentGround(cloud, params.ground);
        const auto result = detectOnGrid(map, cloud, ground, params);
        ASSERT_EQ(result.obstacles.size(), 1U);
        const OrientedBox& box = result.obstacles[0].box;
        const double nearest_face =
            box.center.x() - (std::abs(std::cos(box.yaw)) > 0.7 ? box.size.x() : box.size.y()) / 2;
        EXPECT_NEAR(nearest_face, 10.0, 0.1);
        EXPECT_NEAR(box.center.y(), 0.0, 0.15);
    }
}

TEST(Maps, AnEmptyMapGivesNoBoxes) {
    COccupancyGridMap2D map;
    map.setSize(-5, 5, -5, 5, 0.25F, 0.5F);
    EXPECT_TRUE(detectOnGrid(map, carAhead(), std::nullopt, DetectorParams{}).obstacles.empty());
    EXPECT_TRUE(detectOnGrid(map, PointCloud{}, std::nullopt, DetectorParams{}).obstacles.empty());
}

}  // namespace
}  // namespace lidar_obstacles
