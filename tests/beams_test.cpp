// SPDX-License-Identifier: BSD-3-Clause
// What the beams of a scan tell of themselves: neighbours, roughness, noise, steps.
#include "lidar_obstacles/beams.h"

#include <gtest/gtest.h>

#include "support/feature_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr float kStep = 6.2831853f / 1800.0f;

/// One ring around the sensor at 10 m, a return in each of the columns.
PointCloud ringOf(const std::vector<int>& columns, int all = 1800) {
    PointCloud cloud = cloudOf({});
    cloud.view.rings = 1;
    cloud.view.columns = all;
    cloud.view.index.assign(static_cast<std::size_t>(all), -1);
    for (const int column : columns) {
        const float angle = kStep * static_cast<float>(column);
        cloud.view.index[static_cast<std::size_t>(column)] = static_cast<std::int32_t>(cloud.size());
        cloud.view.column_of.push_back(column);
        cloud.ring.push_back(0);
        cloud.xyz.emplace_back(10.0f * std::cos(angle), 10.0f * std::sin(angle), 1.0f);
    }
    return cloud;
}

TEST(Beams, ANeighbourIsTheNextReturnOfTheRing) {
    const PointCloud cloud = ringOf({100, 101, 102});
    const Beams beams(cloud);
    EXPECT_EQ(beams.beside(1, 1), 2);
    EXPECT_EQ(beams.beside(1, -1), 0);
    EXPECT_EQ(beams.beside(2, 1), -1);
}

TEST(Beams, NeighboursAreFoundAcrossTwoMissingBeamsAndNoMore) {
    const PointCloud cloud = ringOf({100, 103, 107});
    const Beams beams(cloud);
    EXPECT_EQ(beams.beside(0, 1), 1);
    EXPECT_EQ(beams.beside(1, -1), 0);
    EXPECT_EQ(beams.beside(1, 1), -1);
}

TEST(Beams, TheLastColumnIsTheNeighbourOfTheFirst) {
    const PointCloud cloud = ringOf({0, 1799});
    const Beams beams(cloud);
    EXPECT_EQ(beams.beside(0, -1), 1);
    EXPECT_EQ(beams.beside(1, 1), 0);
}

TEST(Beams, ACloudWithoutAViewHasNoNeighboursAndTheLeastNoise) {
    Sensor sensor;
    sensor.rings = false;
    const Scan scan = castRays(street(), sensor);
    const Beams beams(scan.cloud);
    EXPECT_EQ(beams.beside(0, 1), -1);
    EXPECT_LT(beams.roughness(0), 0.0f);
    EXPECT_NEAR(beams.noise(), 0.003f, 1e-6f);
    EXPECT_EQ(beams.ring(0), 0);
}

TEST(Beams, AnEmptyCloudIsServed) {
    const PointCloud cloud;
    EXPECT_GT(Beams(cloud).noise(), 0.0f);
}

TEST(Beams, RangesAreHorizontalAndFromTheSensor) {
    Sensor sensor;
    sensor.position = {1.4, -0.3, 1.7};
    const Scan scan = castRays(street(), sensor);
    const Beams beams(scan.cloud);
    for (std::size_t i = 0; i < scan.cloud.size(); i += 101) {
        const Eigen::Vector3f& p = scan.cloud.xyz[i];
        EXPECT_NEAR(beams.range(static_cast<std::int32_t>(i)), std::hypot(p.x() - 1.4f, p.y() + 0.3f), 1e-4f);
    }
}

TEST(Beams, ABeamRunsStraightFromTheSensorThroughItsReturn) {
    PointCloud cloud = cloudOf({{10.0f, 0.0f, 0.8f}});  // falls by 1 m in 10 m from 1.8 m
    const Beams beams(cloud);
    EXPECT_NEAR(beams.beamHeight(0, 0.0f), 1.8f, 1e-5f);
    EXPECT_NEAR(beams.beamHeight(0, 5.0f), 1.3f, 1e-5f);
    EXPECT_NEAR(beams.beamHeight(0, 10.0f), 0.8f, 1e-5f);
    EXPECT_NEAR(beams.beamHeight(0, 18.0f), 0.0f, 1e-5f);
}

TEST(Beams, StepsAreThoseOfTheSensor) {
    const Scan scan = castRays(street(), Sensor{});
    const Beams beams(scan.cloud);
    EXPECT_NEAR(beams.azimuthStep(), kStep, 1e-7f);
    for (int ring = 0; ring < 15; ++ring) {
        EXPECT_NEAR(beams.stepUp(ring), radians(2.0), radians(0.05)) << ring;
        EXPECT_EQ(beams.stepUp(ring), beams.stepDown(ring + 1)) << ring;
    }
    EXPECT_TRUE(std::isinf(beams.stepDown(0)));
    EXPECT_TRUE(std::isinf(beams.stepUp(15)));
}

TEST(Beams, AFlatWallWithoutNoiseIsNotRough) {
    const Scan scan = scanOf({wallAt(8.0, -3.0, 3.0, 0.0, 3.0)});
    const Beams beams(scan.cloud);
    int counted = 0;
    for (const std::int32_t i : scan.returnsOn(0)) {
        const float rough = beams.roughness(i);
        if (rough < 0.0f) continue;
        ++counted;
        EXPECT_LT(rough, 1e-4f);
    }
    // all but the two ends of each ring, whose neighbours lie on another surface
    EXPECT_GT(counted, static_cast<int>(scan.returnsOn(0).size()) - 2 * 16 - 1);
}

TEST(Beams, TheRoughnessOfAFlatWallIsAboutTheNoise) {
    for (const double noise : {0.005, 0.01, 0.02}) {  // less than the 2.8 cm between the beams
        Sensor sensor;
        sensor.noise = noise;
        const Scan scan = scanOf({wallAt(8.0, -3.0, 3.0, 0.0, 3.0)}, sensor);
        const Beams beams(scan.cloud);
        std::vector<float> rough;
        for (const std::int32_t i : scan.returnsOn(0))
            if (beams.roughness(i) >= 0.0f) rough.push_back(beams.roughness(i));
        ASSERT_GT(rough.size(), 500u);
        std::nth_element(rough.begin(), rough.begin() + static_cast<std::ptrdiff_t>(rough.size() / 2), rough.end());
        // sqrt(1.5) of the noise, and of normal errors half are smaller than 0.674 deviations; the wall is seen at up
        // to 20 deg, and its mean error is known to 1 / sqrt(500)
        EXPECT_NEAR(rough[rough.size() / 2], 0.674 * std::sqrt(1.5) * noise, 0.15 * noise) << noise;
    }
}

TEST(Beams, AReturnBesideAnotherSurfaceHasNoRoughness) {
    PointCloud cloud = ringOf({100, 101, 102});
    cloud.xyz[2] *= 1.2f;  // 2 m behind
    EXPECT_LT(Beams(cloud).roughness(1), 0.0f);
    cloud.xyz[2] /= 1.2f;
    EXPECT_GE(Beams(cloud).roughness(1), 0.0f);
}

TEST(Beams, TheNoiseIsEstimatedFromTheScan) {
    // of more noise than neighbouring beams are apart the line between neighbours takes up a part
    for (const double noise : {0.01, 0.02, 0.03})
        for (const int planes : {16, 8}) {
            Sensor sensor = fewPlanes(planes);
            sensor.noise = noise;
            const Scan scan = castRays(street(), sensor);
            EXPECT_NEAR(Beams(scan.cloud).noise(), noise, 0.3 * noise) << planes << " planes";
        }
}

TEST(Beams, WithoutNoiseItIsNoLessThanRangesAreResolved) {
    const Scan scan = castRays(street(), Sensor{});
    EXPECT_NEAR(Beams(scan.cloud).noise(), 0.003f, 0.001f);
}

}  // namespace
}  // namespace lidar_obstacles
