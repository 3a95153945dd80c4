// SPDX-License-Identifier: BSD-3-Clause
// The grid of Sec. IV: cells of 0.05 m, and the cells of a cluster.
#include <gtest/gtest.h>

#include <set>

#include "lidar_obstacles/grid_image.h"
#include "lidar_obstacles/occupancy_grid.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using Points = std::vector<Eigen::Vector3f>;

struct Grids {
    PointCloud cloud;
    GroundModel ground;
    OccupancyGrid fine;
    OccupancyGrid usual;

    explicit Grids(const Points& points, const DetectorParams& params = {}) : cloud(cloudOf(points)) {
        ground = knownGround(cloud);
        for (std::size_t i = 0; i < cloud.size(); ++i) ground.is_ground[i] = cloud.xyz[i].z() < 0.1f;
        const auto candidates = cropToRegion(cloud, ground, params.region);
        fine = buildFineGrid(cloud, candidates, ground, {params.region, params.grid});
        usual = buildOccupancyGrid(cloud, candidates, ground, {params.region, params.grid});
    }
};

/// Every centimetre of a wall across the view, 20 m ahead.
Points wall() {
    Points points;
    for (int k = 0; k <= 300; ++k) points.emplace_back(20.01f, -1.5f + 0.01f * static_cast<float>(k), 1.0f);
    return points;
}

TEST(FineGrid, HasCellsOfFineResolutionOverTheSameRegion) {
    const Grids g({});
    EXPECT_EQ(g.fine.resolution, GridParams{}.fine_resolution);
    EXPECT_NEAR(g.fine.width * g.fine.resolution, g.usual.width * g.usual.resolution, 0.2);
    EXPECT_NEAR(g.fine.height * g.fine.resolution, g.usual.height * g.usual.resolution, 0.2);
    DetectorParams params;
    params.grid.fine_resolution = 0.1;
    EXPECT_EQ(Grids({}, params).fine.resolution, 0.1);
}

TEST(FineGrid, AWallOccupiesEachCellAlongItOnce) {
    const Grids g(wall());
    EXPECT_EQ(g.fine.occupied.size(), 61u);  // 3 m and one for the borders
    EXPECT_TRUE(std::is_sorted(g.fine.occupied.begin(), g.fine.occupied.end()));
    EXPECT_EQ(std::set<std::int32_t>(g.fine.occupied.begin(), g.fine.occupied.end()).size(), g.fine.occupied.size());
}

TEST(FineGrid, GroundReturnsFreeItsCells) {
    const Grids g({{10.01f, 0.01f, 0.0f}, {20.01f, 0.01f, 0.0f}, {20.01f, 0.01f, 1.0f}});
    EXPECT_EQ(cv::countNonZero(stateImage(g.fine) == static_cast<int>(CellState::Free)), 1);
    EXPECT_EQ(cv::countNonZero(stateImage(g.fine) == static_cast<int>(CellState::Occupied)), 1) << "occupied wins";
}

TEST(AddCells, EachCellOfAClusterIsNamedOnceByItsCentre) {
    const Grids g(wall());
    const auto clusters = addCells({clusterOf(allReturns(g.cloud), g.ground)}, g.cloud, g.ground, g.fine);
    ASSERT_EQ(clusters.size(), 1u);
    EXPECT_EQ(clusters[0].points.size(), g.cloud.size());
    ASSERT_EQ(clusters[0].cells.size(), g.fine.occupied.size());
    std::set<std::pair<float, float>> named;
    for (const Eigen::Vector2f& c : clusters[0].cells) {
        EXPECT_TRUE(named.insert({c.x(), c.y()}).second);
        int col = 0;
        int row = 0;
        ASSERT_TRUE(g.fine.cellAt(c.x(), c.y(), col, row));
        EXPECT_NEAR((g.fine.cellCenter(col, row).cast<float>() - c).norm(), 0.0f, 1e-4f);
        EXPECT_TRUE(std::binary_search(g.fine.occupied.begin(), g.fine.occupied.end(), row * g.fine.width + col));
    }
}

TEST(AddCells, EveryReturnLiesInACellOfItsCluster) {
    const Grids g({{10.0f, 3.0f, 1.0f}, {-4.2f, 7.7f, 0.5f}, {-4.21f, 7.7f, 2.0f}, {30.0f, -20.0f, 1.0f}});
    const auto clusters = addCells({clusterOf(allReturns(g.cloud), g.ground)}, g.cloud, g.ground, g.fine);
    for (const Eigen::Vector3f& p : g.cloud.xyz) {
        float nearest = 1e9f;
        for (const Eigen::Vector2f& c : clusters[0].cells)
            nearest = std::min(nearest, (c - p.head<2>()).cwiseAbs().maxCoeff());
        EXPECT_LE(nearest, 0.5f * 0.05f + 1e-4f);
    }
}

TEST(AddCells, ReturnsOutsideTheGridHaveNoCell) {
    const Grids g({{10.0f, 3.0f, 1.0f}, {200.0f, 3.0f, 1.0f}});
    EXPECT_EQ(addCells({clusterOf({0, 1}, g.ground)}, g.cloud, g.ground, g.fine)[0].cells.size(), 1u);
    EXPECT_TRUE(addCells({clusterOf({1}, g.ground)}, g.cloud, g.ground, g.fine)[0].cells.empty());
}

TEST(AddCells, OnABankCellsLieWhereTheNormalLeads) {
    PointCloud cloud;
    GroundModel ground;
    const double bank = radians(5.0);
    ground.normal = Eigen::Vector3d(0.0, -std::sin(bank), std::cos(bank));
    for (int k = 0; k < 20; ++k) {  // a post of 1.9 m upright on the bank leans by 0.17 m, three cells
        const Eigen::Vector3d p = Eigen::Vector3d(20.02, 10.02, 10.02 * std::tan(bank)) + 0.1 * k * ground.normal;
        cloud.xyz.push_back(p.cast<float>());
        ground.height.push_back(static_cast<float>(0.1 * k / ground.normal.z()));
    }
    ground.is_ground.assign(20, 0);
    const OccupancyGrid grid = buildFineGrid(cloud, allReturns(cloud), ground, {});
    EXPECT_EQ(addCells({clusterOf(allReturns(cloud), ground)}, cloud, ground, grid)[0].cells.size(), 1u);
}

TEST(AddCells, NoClustersHaveNone) {
    const Grids g({});
    EXPECT_TRUE(addCells({}, g.cloud, g.ground, g.fine).empty());
}

}  // namespace
}  // namespace lidar_obstacles
