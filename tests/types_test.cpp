// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/types.h"
#include "lidar_obstacles/grid_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>

namespace lidar_obstacles {
namespace {

OccupancyGrid smallGrid() {
    OccupancyGrid grid;
    grid.origin = {-1.0, 2.0};
    grid.resolution = 0.5;
    grid.width = 6;   // x: -1 .. 2
    grid.height = 4;  // y: 2 .. 4
    return grid;
}

TEST(OccupancyGrid, ACellHoldsItsLowerBorderAndNotItsUpper) {
    const OccupancyGrid grid = smallGrid();
    int col = -1;
    int row = -1;
    ASSERT_TRUE(grid.cellAt(-1.0, 2.0, col, row));
    EXPECT_EQ(col, 0);
    EXPECT_EQ(row, 0);
    ASSERT_TRUE(grid.cellAt(-0.5, 2.499, col, row));
    EXPECT_EQ(col, 1);
    EXPECT_EQ(row, 0);
    ASSERT_TRUE(grid.cellAt(1.999, 3.999, col, row));
    EXPECT_EQ(col, 5);
    EXPECT_EQ(row, 3);
}

TEST(OccupancyGrid, PointsJustOutsideAreOutside) {
    const OccupancyGrid grid = smallGrid();
    int col = 0;
    int row = 0;
    EXPECT_FALSE(grid.cellAt(-1.001, 3.0, col, row)) << "cut towards zero would put this into column 0";
    EXPECT_FALSE(grid.cellAt(0.0, 1.999, col, row));
    EXPECT_FALSE(grid.cellAt(2.0, 3.0, col, row));
    EXPECT_FALSE(grid.cellAt(0.0, 4.0, col, row));
}

TEST(OccupancyGrid, EachCellHoldsItsOwnCentre) {
    const OccupancyGrid grid = smallGrid();
    for (int r = 0; r < grid.height; ++r)
        for (int c = 0; c < grid.width; ++c) {
            const Eigen::Vector2d center = grid.cellCenter(c, r);
            int col = -1;
            int row = -1;
            ASSERT_TRUE(grid.cellAt(center.x(), center.y(), col, row));
            EXPECT_EQ(col, c);
            EXPECT_EQ(row, r);
        }
}

TEST(OccupancyGrid, AGridWithoutCellsHoldsNothing) {
    OccupancyGrid grid;
    grid.resolution = 0.2;
    int col = 0;
    int row = 0;
    EXPECT_FALSE(grid.cellAt(0.0, 0.0, col, row));
}

TEST(OrganizedView, TheLastColumnIsTheNeighbourOfTheFirst) {
    OrganizedView view;
    view.rings = 1;
    view.columns = 8;
    EXPECT_EQ(view.wrap(8), 0);
    EXPECT_EQ(view.wrap(-1), 7);
    EXPECT_EQ(view.wrap(-9), 7);
    EXPECT_EQ(view.wrap(3), 3);
}

TEST(GroundModel, WithoutEvidenceTheGroundIsZeroEverywhere) { EXPECT_EQ(GroundModel{}.heightAt(12.0, -3.0), 0.0); }

/// Four directions (-180, -90, 0, 90 deg) and two circles; node k rises by k metres.
GroundModel fourDirections() {
    GroundModel model;
    model.sectors = 4;
    model.ranges = {5.0, 15.0};
    for (int k = 0; k < 8; ++k) model.rise.push_back(k);
    return model;
}

TEST(GroundModel, HasTheHeightOfItsNodes) {
    const GroundModel model = fourDirections();
    EXPECT_NEAR(model.heightAt(-5.0, 0.0), 0.0, 1e-5);
    EXPECT_NEAR(model.heightAt(-15.0, 0.0), 1.0, 1e-5);
    EXPECT_NEAR(model.heightAt(0.0, -5.0), 2.0, 1e-5);
    EXPECT_NEAR(model.heightAt(15.0, 0.0), 5.0, 1e-5);
    EXPECT_NEAR(model.heightAt(0.0, 15.0), 7.0, 1e-5);
}

TEST(GroundModel, IsLinearBetweenItsNodesAndLevelBeyondThem) {
    const GroundModel model = fourDirections();
    EXPECT_NEAR(model.heightAt(7.5, 0.0), 4.25, 1e-5) << "outwards";
    EXPECT_NEAR(model.heightAt(15.0 * std::sqrt(0.5), 15.0 * std::sqrt(0.5)), 6.0, 1e-5) << "along a circle";
    EXPECT_NEAR(model.heightAt(-5.0 * std::sqrt(0.5), 5.0 * std::sqrt(0.5)), 3.0, 1e-5) << "where the angle jumps";
    EXPECT_NEAR(model.heightAt(40.0, 0.0), 5.0, 1e-5);
    EXPECT_NEAR(model.heightAt(1.0, 0.0), 4.0, 1e-5);
}

TEST(GroundModel, LiesOnItsPlane) {
    GroundModel model = fourDirections();
    model.plane.slope = {0.1, -0.2};
    model.plane.offset = 0.5;
    EXPECT_NEAR(model.heightAt(15.0, 0.0), 5.0 + 0.5 + 1.5, 1e-5);
}

TEST(GroundModel, HasNoStep) {
    GroundModel model;
    model.sectors = 24;
    model.ranges = {1.5, 2.5, 4.0, 9.0, 20.0, 40.0};
    cv::RNG random(5);
    for (int k = 0; k < 24 * 6; ++k) model.rise.push_back(random.uniform(-0.3, 0.3));
    constexpr double kStep = 0.001;
    for (int k = 0; k < 40000; ++k) {  // along circles and a ray
        const double a = 0.000157 * k, r = 1.0 + 0.001 * k;
        for (const double radius : {1.5, 3.0, 10.0, 25.0})
            EXPECT_NEAR(model.heightAt(radius * std::cos(a), radius * std::sin(a)),
                        model.heightAt(radius * std::cos(a + kStep), radius * std::sin(a + kStep)), 5e-3);
        EXPECT_NEAR(model.heightAt(r, -0.3 * r), model.heightAt(r + kStep, -0.3 * (r + kStep)), 2e-3);
    }
}

TEST(GroundModel, DirectionsAreCountedFromTheCentre) {
    GroundModel model = fourDirections();
    model.center = {5.0, 5.0};
    EXPECT_NEAR(model.heightAt(0.0, 5.0), 0.0, 1e-5);
    EXPECT_NEAR(model.heightAt(20.0, 5.0), 5.0, 1e-5);
}

TEST(GroundPlane, TellsTheHeightOfATiltedPlane) {
    GroundPlane plane;
    plane.slope = {0.1, -0.2};
    plane.offset = 0.5;
    EXPECT_DOUBLE_EQ(plane.heightAt(10.0, 5.0), 0.5);
    EXPECT_DOUBLE_EQ(plane.heightAt(-10.0, 0.0), -0.5);
}

TEST(NormalizeAngle, ReachesMinusPiAndStaysBelowPi) {
    EXPECT_DOUBLE_EQ(normalizeAngle(0.0), 0.0);
    EXPECT_DOUBLE_EQ(normalizeAngle(M_PI), -M_PI);
    EXPECT_DOUBLE_EQ(normalizeAngle(-M_PI), -M_PI);
    EXPECT_NEAR(normalizeAngle(1.5 * M_PI), -0.5 * M_PI, 1e-12);
    EXPECT_NEAR(normalizeAngle(-7.25 * M_PI), 0.75 * M_PI, 1e-12);
    const double just_below = std::nextafter(-M_PI, -10.0);
    for (const double a : {just_below, -1e-17, 1e6, -1e6, 3 * M_PI, -3 * M_PI}) {
        EXPECT_GE(normalizeAngle(a), -M_PI) << a;
        EXPECT_LT(normalizeAngle(a), M_PI) << a;
    }
}

TEST(ToString, NamesAreThoseOfTheFiles) {
    EXPECT_STREQ(toString(ObstacleClass::Vehicle), "vehicle");
    EXPECT_STREQ(toString(ObstacleClass::Pedestrian), "pedestrian");
    EXPECT_STREQ(toString(ObstacleClass::Cyclist), "cyclist");
    EXPECT_STREQ(toString(ObstacleClass::Structure), "structure");
    EXPECT_STREQ(toString(ObstacleClass::Unknown), "unknown");
    EXPECT_STREQ(toString(RejectReason::TooFewPoints), "too_few_points");
    EXPECT_STREQ(toString(RejectReason::TooSmall), "too_small");
    EXPECT_STREQ(toString(RejectReason::TooLow), "too_low");
    EXPECT_STREQ(toString(RejectReason::TooLarge), "too_large");
    EXPECT_STREQ(toString(RejectReason::Floating), "floating");
    EXPECT_STREQ(toString(GroundEvidence::None), "none");
    EXPECT_STREQ(toString(GroundEvidence::Weak), "weak");
    EXPECT_STREQ(toString(GroundEvidence::Good), "good");
}

TEST(ToString, HeadingRulesAreNamedAsInTheFiles) {
    EXPECT_STREQ(toString(HeadingRule::None), "none");
    EXPECT_STREQ(toString(HeadingRule::Plane), "plane");
    EXPECT_STREQ(toString(HeadingRule::TwoSides), "two_sides");
    EXPECT_STREQ(toString(HeadingRule::Line), "line");
}

TEST(FacesText, NamesEachFaceByItsLetterInOneOrder) {
    EXPECT_EQ(facesText(0), "-");
    EXPECT_EQ(facesText(kFront), "F");
    EXPECT_EQ(facesText(kBack), "B");
    EXPECT_EQ(facesText(kLeft), "L");
    EXPECT_EQ(facesText(kRight), "R");
    EXPECT_EQ(facesText(kRight | kBack), "BR");
    EXPECT_EQ(facesText(kFront | kBack | kLeft | kRight), "FBLR");
}

TEST(StateImage, ShowsEveryCellWhereItLies) {
    OccupancyGrid grid = smallGrid();
    grid.occupied = {0, 13};
    grid.free = {5, 5, 13, 23};
    const cv::Mat1b image = stateImage(grid);
    ASSERT_EQ(image.size(), cv::Size(6, 4));
    for (int row = 0; row < 4; ++row)
        for (int col = 0; col < 6; ++col) {
            const int cell = row * 6 + col;
            const CellState state = cell == 0 || cell == 13   ? CellState::Occupied
                                    : cell == 5 || cell == 23 ? CellState::Free
                                                              : CellState::Unknown;
            EXPECT_EQ(static_cast<CellState>(image(row, col)), state) << "cell " << cell << "; occupied wins over free";
        }
    EXPECT_TRUE(stateImage(OccupancyGrid{}).empty());
}

TEST(GridOf, IsTheInverseOfStateImage) {
    cv::Mat1b states(4, 6, static_cast<std::uint8_t>(CellState::Unknown));
    states(0, 5) = static_cast<std::uint8_t>(CellState::Free);
    states(2, 1) = static_cast<std::uint8_t>(CellState::Occupied);
    states(3, 5) = static_cast<std::uint8_t>(CellState::Occupied);
    const OccupancyGrid grid = gridOf(states, {-1.0, 2.0}, 0.5);
    EXPECT_EQ(grid.width, 6);
    EXPECT_EQ(grid.height, 4);
    EXPECT_EQ(grid.origin, Eigen::Vector2d(-1.0, 2.0));
    EXPECT_EQ(grid.resolution, 0.5);
    EXPECT_EQ(grid.occupied, (std::vector<std::int32_t>{13, 23})) << "rising";
    EXPECT_EQ(grid.free, std::vector<std::int32_t>{5});
    EXPECT_TRUE(grid.place_of_candidate.empty());
    EXPECT_EQ(cv::countNonZero(stateImage(grid) != states), 0);
    EXPECT_TRUE(gridOf(cv::Mat1b(), {0.0, 0.0}, 0.5).empty());
}

TEST(GridOf, APartOfALargerImageIsReadWithItsOwnWidth) {
    cv::Mat1b larger(10, 10, static_cast<std::uint8_t>(CellState::Occupied));
    cv::Mat1b part = larger(cv::Rect(2, 3, 6, 4));
    part.setTo(static_cast<std::uint8_t>(CellState::Unknown));
    part(1, 2) = static_cast<std::uint8_t>(CellState::Occupied);
    EXPECT_EQ(gridOf(part, {0.0, 0.0}, 0.5).occupied, std::vector<std::int32_t>{8});
}

TEST(OccupancyGrid, ACellsNumberTellsItsCentre) {
    const OccupancyGrid grid = smallGrid();
    EXPECT_EQ(grid.cellCenter(13), grid.cellCenter(1, 2));
}

TEST(PointCloud, AViewThatDoesNotFitIsRefused) {
    PointCloud cloud;
    cloud.xyz = {{1.F, 0.F, 0.F}};
    cloud.ring = {0};
    cloud.view.rings = 1;
    cloud.view.columns = 2;
    cloud.view.index = {0, -1};
    cloud.view.column_of = {0};
    EXPECT_NO_THROW(validate(cloud));
    PointCloud bad = cloud;
    bad.ring = {1};
    EXPECT_THROW(validate(bad), std::invalid_argument) << "a ring that the view has not";
    bad = cloud;
    bad.view.index = {0};
    EXPECT_THROW(validate(bad), std::invalid_argument) << "too few places";
    bad = cloud;
    bad.view.index = {1, -1};
    EXPECT_THROW(validate(bad), std::invalid_argument) << "a return that is not there";
    bad = cloud;
    bad.xyz[0].x() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(validate(bad), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles
