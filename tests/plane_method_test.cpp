// SPDX-License-Identifier: BSD-3-Clause
// The paper's single plane (Sec. III.A, Fig. 3) as the source of the heading.
#include <gtest/gtest.h>

#include "lidar_obstacles/plane_fit.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr double kNoise = 0.02;

DetectorParams paperParams(int seed = 1) {
    DetectorParams params;
    params.plane_fit.method = BoxMethod::Plane;
    params.plane_fit.seed = seed;
    return params;
}

Obstacle fit(const OrientedBox& box, const DetectorParams& params) {
    World world = flatWorld();
    world.boxes = {box};
    Sensor sensor;
    sensor.noise = kNoise;
    const Scan scan = castRays(world, sensor);
    const GroundModel ground = knownGround(scan);
    return fitPlaneBox(clusterOf(scan.returnsOn(0), ground), scan.cloud, ground, {params.plane_fit, params.box});
}

Obstacle fitPoints(const std::vector<Eigen::Vector3f>& points) {
    const PointCloud cloud = cloudOf(points);
    const GroundModel ground = knownGround(cloud);
    return fitPlaneBox(clusterOf(allReturns(cloud), ground), cloud, ground,
                       {paperParams().plane_fit, paperParams().box});
}

/// Three standard deviations of a direction from n returns on a face of that length, and a degree for returns near the
/// corner that lie within the plane's inlier distance without being on the face.
double bound(double face, int returns) { return 1.0 + 3.0 * degrees(kNoise / (face * std::sqrt(returns / 12.0))); }

TEST(PaperPlane, TheOnlyFaceSeenTellsTheHeading) {
    for (const double x : {8.0, 12.0, 18.0}) {
        const Obstacle rear = fit(carAt(x, 0.0, 0.0), paperParams());
        EXPECT_TRUE(rear.heading_valid);
        EXPECT_LE(headingError(rear.box.yaw, 0.0), bound(1.8, rear.num_points)) << x;
        const Obstacle side = fit(carAt(x, 0.0, 90.0), paperParams());
        EXPECT_LE(headingError(side.box.yaw, M_PI / 2), bound(4.5, side.num_points)) << x;
    }
}

TEST(PaperPlane, OfTwoFacesOneIsTakenAndNotADiagonal) {
    for (double yaw = 15.0; yaw <= 75.0; yaw += 15.0) {
        const Obstacle o = fit(carAt(10.0, 1.0, yaw), paperParams());
        const double off_axis = degrees(std::abs(std::remainder(o.box.yaw - radians(yaw), M_PI / 2)));
        EXPECT_LE(off_axis, bound(1.8, o.num_points / 2)) << "yaw " << yaw;
    }
}

TEST(PaperPlane, AnotherSeedTellsTheSameHeading) {
    const Obstacle a = fit(carAt(12.0, 0.0, 0.0), paperParams(1));
    const Obstacle b = fit(carAt(12.0, 0.0, 0.0), paperParams(99));
    EXPECT_LE(headingError(a.box.yaw, b.box.yaw), 2.0 * bound(1.8, a.num_points));
}

TEST(PaperPlane, TheSameSeedGivesTheSameBoxBitForBit) {
    const Obstacle a = fit(carAt(12.0, 3.0, 40.0), paperParams());
    const Obstacle b = fit(carAt(12.0, 3.0, 40.0), paperParams());
    EXPECT_EQ(a.box.yaw, b.box.yaw);
    EXPECT_EQ(a.box.center, b.box.center);
    EXPECT_EQ(a.box.size, b.box.size);
}

TEST(PaperPlane, WithoutAPlaneThereIsABoxButNoHeading) {
    for (const auto& points : {std::vector<Eigen::Vector3f>{{10.0f, -2.0f, 1.0f}},
                               std::vector<Eigen::Vector3f>{{10.0f, -2.0f, 1.0f}, {10.0f, 2.0f, 1.0f}},
                               std::vector<Eigen::Vector3f>(20, {10.0f, 3.0f, 1.0f})}) {
        const Obstacle o = fitPoints(points);
        EXPECT_FALSE(o.heading_valid);
        EXPECT_TRUE(isFinite(o.box));
        EXPECT_GT(o.box.size.minCoeff(), 0.0);
    }
}

TEST(PaperPlane, ALineAlongTheLineOfSightIsNoFacingPlane) {
    std::vector<Eigen::Vector3f> points;
    for (int k = 0; k <= 40; ++k) points.emplace_back(10.0f + 0.1f * static_cast<float>(k), 0.0f, 1.0f);
    const Obstacle o = fitPoints(points);
    EXPECT_FALSE(o.heading_valid);
    EXPECT_TRUE(isFinite(o.box));
}

}  // namespace
}  // namespace lidar_obstacles
