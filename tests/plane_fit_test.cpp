// SPDX-License-Identifier: BSD-3-Clause
// Headings and faces of boxes fitted to what a sensor sees of known boxes.
#include "lidar_obstacles/plane_fit.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr double kNoise = 0.02;  // of the range [m]

struct Fit {
    OrientedBox truth;
    Obstacle found;
    int returns = 0;

    double heading() const { return headingError(found.box.yaw, truth.yaw); }
    /// By how much the found box is nearer to the sensor than the true one [m].
    double face() const {
        return distanceTo(truth, Eigen::Vector2d::Zero()) - distanceTo(found.box, Eigen::Vector2d::Zero());
    }
};

/// The box fitted to the returns of the only box in a world.
Fit fit(const OrientedBox& box, double noise = 0.0) {
    World world = flatWorld();
    world.boxes = {box};
    Sensor sensor;
    sensor.noise = noise;
    const Scan scan = castRays(world, sensor);
    const GroundModel ground = knownGround(scan);
    const Cluster cluster = clusterOf(scan.returnsOn(0), ground);
    return {box, fitPlaneBox(cluster, scan.cloud, ground, {}), static_cast<int>(cluster.points.size())};
}

Obstacle fitPoints(const std::vector<Eigen::Vector3f>& points) {
    const PointCloud cloud = cloudOf(points);
    const GroundModel ground = knownGround(cloud);
    return fitPlaneBox(clusterOf(allReturns(cloud), ground), cloud, ground, {});
}

std::string at(const OrientedBox& box) {
    return "box at " + std::to_string(box.center.x()) + ", " + std::to_string(box.center.y()) + " yaw " +
           std::to_string(degrees(box.yaw));
}

/// The bound of a heading from a face of length L with n returns of noise s: three times s / (L sqrt(n / 12)), and
/// half a degree for returns near the corner that count to the wrong face.
double headingBound(const Fit& f) {
    const double face = f.truth.size.y();  // the shorter one is the worst that may be all there is to see
    return 0.5 + 3.0 * degrees(kNoise / (face * std::sqrt(f.returns / 12.0)));
}

TEST(PlaneFit, TheHeadingOfACarIsFoundInEveryDirection) {
    for (const double range : {7.0, 10.0, 15.0, 20.0})
        for (double yaw = -90.0; yaw < 90.0; yaw += 15.0) {
            const OrientedBox car = carAt(range * std::cos(0.3), range * std::sin(0.3), yaw);
            SCOPED_TRACE(at(car));
            EXPECT_LE(fit(car).heading(), 0.5);
            const Fit noisy = fit(car, kNoise);
            EXPECT_TRUE(noisy.found.heading_valid);
            EXPECT_LE(noisy.heading(), headingBound(noisy)) << noisy.returns << " returns";
        }
}

TEST(PlaneFit, TheNearFaceLiesWhereTheCarIs) {
    for (const double range : {7.0, 12.0, 20.0})
        for (double yaw = -90.0; yaw < 90.0; yaw += 15.0) {
            const OrientedBox car = carAt(range, 0.2 * range, yaw);
            SCOPED_TRACE(at(car));
            // a corner may lie half a column from the last return: range * 0.1 deg, told along the face
            EXPECT_NEAR(fit(car).face(), 0.0, 0.02 + range * radians(0.1));
            // the box encloses its returns: the nearest of n is about three standard deviations in front
            EXPECT_NEAR(fit(car, kNoise).face(), 0.0, 0.02 + range * radians(0.1) + 3.5 * kNoise);
        }
}

TEST(PlaneFit, TheBoxEnclosesItsReturns) {
    for (double yaw = -90.0; yaw < 90.0; yaw += 15.0) {
        World world = flatWorld();
        world.boxes = {carAt(9.0, -4.0, yaw)};
        const Scan scan = castRays(world, Sensor{});
        const GroundModel ground = knownGround(scan);
        const Obstacle o = fitPlaneBox(clusterOf(scan.returnsOn(0), ground), scan.cloud, ground, {});
        double outside = 0.0;
        for (const std::int32_t i : o.points) {
            // the outermost returns of a face may lie before it, as far as they count as lying on it
            const double distance = distanceTo(o.box, scan.cloud.xyz[i].head<2>().cast<double>());
            EXPECT_LE(distance, BoxParams{}.face_distance);
            outside += distance > 0.001;
            EXPECT_LE(scan.cloud.xyz[i].z(), o.box.center.z() + 0.5 * o.box.size.z() + 1e-4);
        }
        EXPECT_LE(outside, 0.1 * o.num_points) << yaw;
    }
}

TEST(PlaneFit, BothSeenSidesOfACarTellItsSize) {
    const Fit f = fit(carAt(8.0, 6.0, 0.0));
    // each end may lie a column beyond the last return: 10 m * 0.2 deg = 3.5 cm, along a side seen at 37 deg 6 cm
    EXPECT_NEAR(f.found.box.size.x(), 4.5, 0.12);
    EXPECT_NEAR(f.found.box.size.y(), 1.8, 0.08);
}

TEST(PlaneFit, TheBottomLiesOnTheGroundAndTheTopAtTheHighestReturn) {
    const Fit f = fit(carAt(8.0, 3.0, 20.0));
    EXPECT_NEAR(f.found.box.center.z() - 0.5 * f.found.box.size.z(), 0.0, 1e-6);
    const double top = f.found.box.size.z();
    EXPECT_LE(top, 1.5 + 1e-5);
    EXPECT_GE(top, 1.5 - 9.0 * std::tan(radians(2.0)));  // one plane's distance at 9 m
}

TEST(PlaneFit, AVanSeenFromBehindHeadsAlongTheLineOfSight) {
    // only the rear is seen, 2.0 m wide: taking the longer side of what is seen would be 90 deg off
    for (const double x : {9.0, 14.0, 20.0})
        for (const double yaw : {0.0, 4.0, -4.0}) {
            const OrientedBox van = boxAt(x, 0.0, yaw, {5.5, 2.0, 2.4});
            SCOPED_TRACE(at(van));
            const Fit f = fit(van, kNoise);
            EXPECT_LE(f.heading(), headingBound(f));
        }
}

TEST(PlaneFit, ACarAheadSeenFromBehindHeadsAlongTheLineOfSight) {
    for (const double x : {8.0, 12.0, 18.0}) {
        const Fit f = fit(carAt(x, 0.0, 0.0), kNoise);
        EXPECT_LE(f.heading(), headingBound(f)) << x;
    }
}

TEST(PlaneFit, ACarAlongsideHeadsAlongItsSide) {
    for (const double x : {-3.0, 0.0, 2.0})
        for (const double y : {-3.5, 3.0}) {
            const OrientedBox car = carAt(x, y, 3.0);
            SCOPED_TRACE(at(car));
            const Fit f = fit(car, kNoise);
            EXPECT_LE(f.heading(), headingBound(f));
            EXPECT_NEAR(f.found.box.size.x(), 4.5, 0.15);
        }
}

TEST(PlaneFit, ACarCrossingAheadHeadsAcross) {
    for (const double x : {8.0, 15.0}) {
        const Fit f = fit(carAt(x, 0.0, 90.0), kNoise);
        EXPECT_LE(f.heading(), headingBound(f)) << x;
    }
}

TEST(PlaneFit, TheStandardDeviationOfTheHeadingShrinksWithTheFaceThatIsSeen) {
    const Fit rear = fit(carAt(20.0, 0.0, 0.0), kNoise);
    const Fit side = fit(carAt(20.0, 0.0, 90.0), kNoise);
    EXPECT_GT(rear.found.heading_std, side.found.heading_std);
    EXPECT_GT(side.found.heading_std, 0.0);
    EXPECT_LT(rear.found.heading_std, radians(5.0));
}

TEST(PlaneFit, AClusterWithoutReturnsIsRefused) {
    EXPECT_THROW(fitPlaneBox(Cluster{}, PointCloud{}, GroundModel{}, {}), std::invalid_argument);
    EXPECT_TRUE(fitPlaneBoxes(PointCloud{}, {}, GroundModel{}, {}).empty());
}

TEST(PlaneFit, OneReturnIsABoxAroundItWithoutAHeading) {
    const Obstacle o = fitPoints({{10.0f, -2.0f, 1.0f}});
    EXPECT_FALSE(o.heading_valid);
    EXPECT_EQ(o.heading_std, 0.0);
    EXPECT_EQ(o.num_points, 1);
    EXPECT_TRUE(isFinite(o.box));
    // the smallest box is 0.1 m wide and begins at the return
    EXPECT_LE((o.box.center.head<2>() - Eigen::Vector2d(10.0, -2.0)).norm(), 0.05 * std::sqrt(2.0) + 1e-5);
    EXPECT_GT(o.box.size.minCoeff(), 0.0);
}

TEST(PlaneFit, TwoReturnsHaveNoHeading) {
    const Obstacle o = fitPoints({{10.0f, -1.0f, 1.0f}, {10.0f, 1.0f, 1.0f}});
    EXPECT_FALSE(o.heading_valid);
    EXPECT_TRUE(isFinite(o.box));
    EXPECT_NEAR(std::max(o.box.size.x(), o.box.size.y()), 2.0, 1e-3);
}

TEST(PlaneFit, ReturnsOnOneSpotHaveNoHeading) {
    const Obstacle o = fitPoints(std::vector<Eigen::Vector3f>(20, {10.0f, 3.0f, 1.0f}));
    EXPECT_FALSE(o.heading_valid);
    EXPECT_TRUE(isFinite(o.box));
    EXPECT_GT(o.box.size.minCoeff(), 0.0);
}

TEST(PlaneFit, ReturnsOneAboveTheOtherHaveNoHeading) {
    std::vector<Eigen::Vector3f> points;
    for (int k = 0; k < 10; ++k) points.emplace_back(10.0f, 3.0f, 0.1f * static_cast<float>(k));
    const Obstacle o = fitPoints(points);
    EXPECT_FALSE(o.heading_valid);
    EXPECT_TRUE(isFinite(o.box));
}

TEST(PlaneFit, ReturnsOnALineAreAFace) {
    std::vector<Eigen::Vector3f> points;
    for (int k = 0; k <= 40; ++k) points.emplace_back(10.0f, -2.0f + 0.1f * static_cast<float>(k), 1.0f);
    const Obstacle o = fitPoints(points);
    EXPECT_TRUE(o.heading_valid);
    EXPECT_LE(headingError(o.box.yaw, M_PI / 2), 0.5) << "4 m across: a side, not a rear";
    EXPECT_NEAR(o.box.size.x(), 4.0, 0.01);
    EXPECT_GT(o.box.size.y(), 0.0);
}

TEST(PlaneFit, AClusterAroundTheSensorGivesFiniteNumbers) {
    std::vector<Eigen::Vector3f> points;
    for (int k = 0; k < 60; ++k)
        points.emplace_back(std::cos(0.1f * static_cast<float>(k)), std::sin(0.1f * static_cast<float>(k)), 1.0f);
    points.emplace_back(0.0f, 0.0f, 1.0f);
    const Obstacle o = fitPoints(points);
    EXPECT_TRUE(isFinite(o.box));
    EXPECT_TRUE(std::isfinite(o.heading_std));
}

TEST(PlaneFit, CountsReturnsAndPlanes) {
    const Fit f = fit(carAt(10.0, 2.0, 10.0));
    EXPECT_EQ(f.found.num_points, f.returns);
    EXPECT_EQ(f.found.points.size(), static_cast<std::size_t>(f.returns));
    // seen from 1.8 m at 7.6 .. 12 m: z = 0 .. 1.5 lies between -13.3 deg and -1.4 deg: planes at -13, -11 ... -3
    EXPECT_GE(f.found.num_rings, 5);
    EXPECT_LE(f.found.num_rings, 7);
    EXPECT_EQ(fitPoints({{10.0f, -2.0f, 1.0f}}).num_rings, 0) << "the source has no rings";
}

TEST(PlaneFit, TheSameClusterGivesTheSameBoxBitForBit) {
    const Fit a = fit(carAt(12.0, 3.0, 40.0), kNoise);
    const Fit b = fit(carAt(12.0, 3.0, 40.0), kNoise);
    EXPECT_EQ(a.found.box.center, b.found.box.center);
    EXPECT_EQ(a.found.box.size, b.found.box.size);
    EXPECT_EQ(a.found.box.yaw, b.found.box.yaw);
}

}  // namespace
}  // namespace lidar_obstacles
