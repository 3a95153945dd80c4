// SPDX-License-Identifier: BSD-3-Clause
// Region of interest and grid, on returns put where the answer is known.
#include "lidar_obstacles/occupancy_grid.h"
#include "lidar_obstacles/grid_image.h"

#include <gtest/gtest.h>

#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using Points = std::vector<Eigen::Vector3f>;

CellState stateAt(const OccupancyGrid& grid, double x, double y) {
    int col = 0;
    int row = 0;
    if (!grid.cellAt(x, y, col, row)) throw std::out_of_range("no cell there");
    return static_cast<CellState>(stateImage(grid)(row, col));
}

/// The grid of a cloud on the known ground z = 0; returns lower than 0.1 m are ground.
OccupancyGrid gridAround(const PointCloud& cloud, const DetectorParams& params = {}) {
    GroundModel ground = knownGround(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) ground.is_ground[i] = cloud.xyz[i].z() < 0.1f;
    return buildOccupancyGrid(cloud, cropToRegion(cloud, ground, params.region), ground, {params.region, params.grid});
}

DetectorParams withRays() {
    DetectorParams params;
    params.grid.free = FreeSpace::Rays;
    return params;
}

std::vector<std::int32_t> crop(const Points& points, const RegionParams& params = {}) {
    const PointCloud cloud = cloudOf(points);
    return cropToRegion(cloud, knownGround(cloud), params);
}

TEST(Region, AnEmptyCloudLeavesNothing) { EXPECT_TRUE(crop({}).empty()); }

TEST(Region, GroundIsNoCandidate) {
    const PointCloud cloud = cloudOf({{5, 0, 0}, {6, 0, 1}});
    GroundModel ground = knownGround(cloud);
    ground.is_ground[0] = 1;
    EXPECT_EQ(cropToRegion(cloud, ground, RegionParams{}), std::vector<std::int32_t>{1});
}

TEST(Region, ReturnsAboveTheHeightLimitAreNoCandidates) {
    RegionParams params;
    params.max_height = 2.0;
    EXPECT_EQ(crop({{5, 0, 1.9f}, {5, 0, 2.0f}, {5, 0, 2.1f}}, params), (std::vector<std::int32_t>{0, 1}));
}

TEST(Region, HeightCountsFromTheLocalGround) {
    RegionParams params;
    params.max_height = 2.0;
    const PointCloud cloud = cloudOf({{20, 0, 3.0f}, {20, 0, -0.5f}});
    GroundModel ground = knownGround(cloud);
    ground.height = {1.5f, 2.5f};  // the road rises by 1.5 m, respectively falls by 3 m
    EXPECT_EQ(cropToRegion(cloud, ground, params), std::vector<std::int32_t>{0});
}

TEST(Region, LimitsHoldOnAllSides) {
    RegionParams params;
    params.front = 30.0;
    params.rear = 20.0;
    params.lateral = 10.0;
    EXPECT_EQ(crop({{29.9f, 0, 1},
                    {30.1f, 0, 1},
                    {-19.9f, 0, 1},
                    {-20.1f, 0, 1},
                    {5, 9.9f, 1},
                    {5, 10.1f, 1},
                    {5, -9.9f, 1},
                    {5, -10.1f, 1}},
                   params),
              (std::vector<std::int32_t>{0, 2, 4, 6}));
}

TEST(Region, TheOwnVehicleIsNoObstacle) {
    RegionParams params;
    params.own_body = "box(-1.5, 3, -1, 1)";
    EXPECT_EQ(
        crop({{2.9f, 0, 1}, {3.1f, 0, 1}, {-1.4f, 0.9f, 1}, {-1.6f, 0.9f, 1}, {0, 1.1f, 1}, {0, -0.9f, 1}}, params),
        (std::vector<std::int32_t>{1, 3, 4}));
}

TEST(Region, OfTheRectangleOnlyTheOutlineIsSearched) {
    RegionParams params;
    params.outline = "polygon(0 -5, 100 -5, 100 5, 0 5)";
    EXPECT_EQ(crop({{10, 0, 1}, {10, 6, 1}, {-2, 0, 1}, {59, -4, 1}, {61, 0, 1}}, params),
              (std::vector<std::int32_t>{0, 3}));
}

TEST(Region, ExcludedPlacesAreNotSearched) {
    RegionParams params;
    params.excluded = "box(4, 6, -1, 1, 0, 1.5) polygon(-9 -1, -3 -1, -3 1, -9 1) sector(80, 100)";
    const Points points = {{5, 0, 1}, {5, 0, 2}, {-5, 0, 1}, {-10, 0, 1}, {0, 9, 1}, {0, -9, 1}, {9, 9, 1}};
    EXPECT_EQ(crop(points, params), (std::vector<std::int32_t>{1, 3, 5, 6}));
}

TEST(Region, AboveItNothingIsTakenFromWhereItIsNotSearched) {
    RegionParams params;
    const PointCloud cloud = cloudOf({{5, 0, 4}, {5, 9, 4}});
    EXPECT_EQ(cropAboveRegion(cloud, knownGround(cloud), params).size(), 2u);
    params.excluded = "box(4, 6, -1, 1)";
    EXPECT_EQ(cropAboveRegion(cloud, knownGround(cloud), params), std::vector<std::int32_t>{1});
    params.excluded = "none";
    params.outline = "box(4, 6, -1, 1)";
    EXPECT_EQ(cropAboveRegion(cloud, knownGround(cloud), params), std::vector<std::int32_t>{0});
    params.outline = RegionParams{}.outline;
    params.own_body = "box(4, 6, -1, 1)";
    EXPECT_EQ(cropAboveRegion(cloud, knownGround(cloud), params), std::vector<std::int32_t>{1}) << "a high body";
}

TEST(Grid, CoversTheWholeRegionAlsoWhereItIsNoMultipleOfTheCell) {
    DetectorParams params;
    params.region.front = 31.07;
    params.region.rear = 20.03;
    params.region.lateral = 12.11;
    params.grid.resolution = 0.3;
    const OccupancyGrid grid = gridAround(PointCloud{}, params);
    EXPECT_LE(grid.origin.x(), -20.03);
    EXPECT_LE(grid.origin.y(), -12.11);
    EXPECT_GE(grid.origin.x() + grid.width * 0.3, 31.07 - 1e-9);
    EXPECT_GE(grid.origin.y() + grid.height * 0.3, 12.11 - 1e-9);
    EXPECT_LE(grid.width, std::ceil((31.07 + 20.03) / 0.3) + 1);
}

TEST(Grid, AnEmptyCloudLeavesEverythingUnknown) {
    for (const FreeSpace free : {FreeSpace::Ground, FreeSpace::Rays}) {
        DetectorParams params;
        params.grid.free = free;
        const OccupancyGrid grid = gridAround(PointCloud{}, params);
        EXPECT_FALSE(grid.empty());
        EXPECT_EQ(cv::countNonZero(stateImage(grid)), 0);
        EXPECT_TRUE(grid.place_of_candidate.empty());
    }
}

TEST(Grid, AReturnOccupiesTheCellItFallsIntoOnBothSidesOfZero) {
    for (const float x : {-20.01f, 20.01f})
        for (const float y : {-15.01f, 15.01f}) {
            const OccupancyGrid grid = gridAround(cloudOf({{x, y, 1.0f}}));
            EXPECT_EQ(stateAt(grid, x, y), CellState::Occupied);
            EXPECT_EQ(cv::countNonZero(stateImage(grid)), 1);
            ASSERT_EQ(grid.place_of_candidate, std::vector<std::int32_t>{0});
            const Eigen::Vector2d center = grid.cellCenter(grid.occupied[0]);
            EXPECT_LE(std::abs(center.x() - x), 0.5 * grid.resolution + 1e-4);
            EXPECT_LE(std::abs(center.y() - y), 0.5 * grid.resolution + 1e-4);
        }
}

TEST(Grid, ALoneReturnOccupiesACellFarAwayButNotNearby) {
    // a wall across a cell of 0.2 m leaves 0.2 / (2 * 0.0035) = 28 returns per plane at 2 m, and two at 25 m
    EXPECT_EQ(stateAt(gridAround(cloudOf({{2.0f, 1.1f, 1.8f}})), 2.0, 1.1), CellState::Unknown);
    EXPECT_EQ(stateAt(gridAround(cloudOf({{25.0f, 1.1f, 1.8f}})), 25.0, 1.1), CellState::Occupied);
    EXPECT_EQ(stateAt(gridAround(cloudOf(Points(4, {2.1f, 1.1f, 1.8f}))), 2.1, 1.1), CellState::Occupied);
}

TEST(Grid, ListsTheOccupiedCellsInOrderAndTellsTheCandidatesInThem) {
    const Points points = {{20.3f, 5.1f, 1}, {20.01f, 0.1f, 1}, {-3.0f, 9.0f, 1}, {20.3f, 0.1f, 1}, {20.05f, 0.15f, 2}};
    DetectorParams params;
    params.grid.min_fraction = 0.0;
    const OccupancyGrid grid = gridAround(cloudOf(points), params);
    ASSERT_EQ(grid.occupied.size(), 4u);
    EXPECT_TRUE(std::is_sorted(grid.occupied.begin(), grid.occupied.end()));
    // rows first: y = 0.1 (two cells), 5.1, 9.0
    EXPECT_EQ(grid.place_of_candidate, (std::vector<std::int32_t>{2, 0, 3, 1, 0}));
}

TEST(Grid, WhatStandsOneAboveTheOtherAlongTheNormalFallsIntoOnePlace) {
    const Eigen::Vector3f normal = Eigen::Vector3f(-std::tan(radians(5.0)), 0.05f, 1.0f).normalized();
    const Eigen::Vector3f foot(12.0f, -3.0f, 12.0f * std::tan(radians(5.0)) + 3.0f * 0.05f);
    for (const float along : {0.0f, 0.5f, 2.0f}) {
        const float height = along / normal.z();  // along z, as the ground stage tells it
        const Eigen::Vector2f q = projectAlongNormal(foot + along * normal, height, normal);
        EXPECT_NEAR((q - foot.head<2>()).norm(), 0.0f, 1e-5f);
    }
}

TEST(Grid, AWallUprightOnABankOccupiesOneRowOfCells) {
    PointCloud cloud;
    GroundModel ground;
    ground.normal = Eigen::Vector3d(0.0, -std::sin(radians(5.0)), std::cos(radians(5.0)));
    for (int k = 0; k < 20; ++k) {
        const double along = 0.1 * k;  // up to 1.9 m, which leans by 0.17 m
        cloud.xyz.push_back(
            (Eigen::Vector3d(20.1, 10.1, 10.1 * std::tan(radians(5.0))) + along * ground.normal).cast<float>());
        ground.height.push_back(static_cast<float>(along / ground.normal.z()));
    }
    ground.is_ground.assign(20, 0);
    const OccupancyGrid grid = buildOccupancyGrid(cloud, allReturns(cloud), ground, {});
    EXPECT_EQ(cv::countNonZero(stateImage(grid)), 1);
    EXPECT_EQ(stateAt(grid, 20.1, 10.1), CellState::Occupied);
}

TEST(FreeByGround, CellsWithGroundReturnsAreFreeOthersUnknown) {
    const OccupancyGrid grid = gridAround(cloudOf({{10.1f, 0.1f, 0.0f}}));
    EXPECT_EQ(stateAt(grid, 10.1, 0.1), CellState::Free);
    EXPECT_EQ(stateAt(grid, 5.1, 0.1), CellState::Unknown);
    EXPECT_EQ(cv::countNonZero(stateImage(grid)), 1);
}

TEST(FreeByGround, OccupiedWins) {
    const OccupancyGrid grid = gridAround(cloudOf({{10.1f, 0.1f, 0.0f}, {10.1f, 0.1f, 1.0f}, {10.1f, 0.1f, 0.0f}}));
    EXPECT_EQ(stateAt(grid, 10.1, 0.1), CellState::Occupied);
}

TEST(FreeByRays, TheWayToAnObstacleIsFreeAndWhatIsBehindUnknown) {
    const OccupancyGrid grid = gridAround(cloudOf({{10.1f, 0.1f, 1.0f}}), withRays());
    for (const double x : {0.5, 3.0, 6.1, 9.7}) EXPECT_EQ(stateAt(grid, x, 0.1 * x / 10.1), CellState::Free) << x;
    EXPECT_EQ(stateAt(grid, 10.1, 0.1), CellState::Occupied);
    for (const double x : {10.5, 15.0, 30.0}) EXPECT_EQ(stateAt(grid, x, 0.1), CellState::Unknown) << x;
}

TEST(FreeByRays, OccupiedWinsOverRaysThatPassAbove) {
    const OccupancyGrid grid = gridAround(cloudOf({{10.1f, 0.1f, 0.5f}, {20.1f, 0.1f, 1.5f}}), withRays());
    EXPECT_EQ(stateAt(grid, 10.1, 0.1), CellState::Occupied);
    EXPECT_EQ(stateAt(grid, 15.1, 0.1), CellState::Free);
}

TEST(FreeByRays, AGroundReturnFreesItsOwnCell) {
    EXPECT_EQ(stateAt(gridAround(cloudOf({{10.1f, 0.1f, 0.0f}}), withRays()), 10.1, 0.1), CellState::Free);
}

TEST(FreeByRays, RaysToWhatIsAboveTheLimitTellNothingOfTheWay) {
    const OccupancyGrid grid = gridAround(cloudOf({{10.1f, 0.1f, 6.0f}}), withRays());
    EXPECT_EQ(cv::countNonZero(stateImage(grid)), 0);
}

TEST(FreeByRays, FromAHighSensorTheWayIsFreeOnlyBelowTheHeightLimit) {
    DetectorParams params = withRays();
    params.region.max_height = 1.0;
    PointCloud cloud = cloudOf({{10.1f, 0.1f, 0.0f}});
    cloud.sensor_origin.z() = 4.0f;  // the ray comes below 1 m at 10.1 * 3 / 4 = 7.6 m
    const OccupancyGrid grid = gridAround(cloud, params);
    EXPECT_EQ(stateAt(grid, 5.0, 0.05), CellState::Unknown);
    EXPECT_EQ(stateAt(grid, 9.0, 0.09), CellState::Free);
}

TEST(FreeByRays, AReturnOutsideTheGridFreesTheWayInsideIt) {
    DetectorParams params = withRays();
    params.region.front = 15.0;
    const OccupancyGrid grid = gridAround(cloudOf({{40.1f, 0.1f, 1.0f}}), params);
    EXPECT_EQ(stateAt(grid, 12.0, 0.03), CellState::Free);
}

TEST(AssignToCells, TellsTheCellOfEachCandidateInAForeignGrid) {
    OccupancyGrid grid;
    grid.origin = {3.3, -2.7};
    grid.resolution = 0.5;
    grid.width = 12;   // x to 9.3
    grid.height = 10;  // y to 2.3
    grid.occupied = {0, 5, 9 * 12 + 11};
    const PointCloud cloud =
        cloudOf({{3.35f, -2.65f, 1}, {9.25f, 2.25f, 1}, {9.35f, 0, 1}, {3.25f, 0, 1}, {5, 2.35f, 1}});
    const OccupancyGrid out = assignToCells(grid, cloud, allReturns(cloud), knownGround(cloud));
    EXPECT_EQ(out.place_of_candidate, (std::vector<std::int32_t>{0, 2, -1, -1, -1}));
    EXPECT_EQ(out.origin, grid.origin);
}

}  // namespace
}  // namespace lidar_obstacles
