// SPDX-License-Identifier: BSD-3-Clause
// Rings of clouds that name none: recovered where the elevations fall on steps, and only there.
#include "mrpt_bridge/input/elevation_rings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cmath>
#include <random>
#include <string>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "mrpt_bridge/input/point_fields.h"

namespace lidar_obstacles {
namespace {

using Points = std::vector<Eigen::Vector3f>;

struct Cloud {
    Points points;
    std::vector<std::uint16_t> ring;
};

/// 180 returns of each elevation [deg], 2 to 60 m away, in any order. Every return may be seen `offset` further from
/// the axis than its beam begins.
Cloud cloudOf(const std::vector<double>& elevations, double offset = 0.0) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<std::pair<Eigen::Vector3f, std::uint16_t>> all;
    for (std::size_t ring = 0; ring < elevations.size(); ++ring) {
        const double e = elevations[ring] * M_PI / 180.0;
        for (int k = 0; k < 180; ++k) {
            const double azimuth = 2.0 * M_PI * uniform(random), range = 2.0 + 58.0 * uniform(random);
            const double horizontal = range * std::cos(e) + offset;
            all.emplace_back(
                Eigen::Vector3d(horizontal * std::cos(azimuth), horizontal * std::sin(azimuth), range * std::sin(e))
                    .cast<float>(),
                static_cast<std::uint16_t>(ring));
        }
    }
    std::shuffle(all.begin(), all.end(), random);
    Cloud cloud;
    for (const auto& [point, ring] : all) {
        cloud.points.push_back(point);
        cloud.ring.push_back(ring);
    }
    return cloud;
}

std::vector<double> evenSteps(double lowest, double step, int count) {
    std::vector<double> elevations;
    for (int k = 0; k < count; ++k) elevations.push_back(lowest + step * k);
    return elevations;
}

TEST(ElevationRings, AreThoseOfTheSensor) {
    std::vector<double> uneven;  // a sensor whose planes are denser around the horizon
    for (int k = 0; k < 40; ++k) uneven.push_back(-25.0 + (k < 10 ? 1.8 * k : 18.0 + 0.45 * (k - 10)));
    for (const auto& elevations : {evenSteps(-15.0, 2.0, 16), evenSteps(-30.67, 4.0 / 3.0, 32),
                                   evenSteps(-22.5, 45.0 / 127, 128), evenSteps(-45.0, 90.0 / 63, 64), uneven}) {
        const Cloud cloud = cloudOf(elevations);
        const auto found = ringsFromElevations(cloud.points);
        ASSERT_TRUE(found) << elevations.size();
        EXPECT_EQ(found->rings, static_cast<int>(elevations.size()));
        EXPECT_EQ(found->ring, cloud.ring) << elevations.size();
    }
}

TEST(ElevationRings, SurviveBeamsThatBeginBesideTheAxis) {
    const Cloud cloud = cloudOf(evenSteps(-16.6, 33.2 / 63, 64), 0.028);
    const auto found = ringsFromElevations(cloud.points);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->rings, 64);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < cloud.ring.size(); ++i) wrong += found->ring[i] != cloud.ring[i];
    EXPECT_LT(wrong, cloud.ring.size() / 50) << "near returns only";
}

TEST(ElevationRings, CountThoseThatSawNothing) {
    std::vector<double> elevations = evenSteps(-15.0, 2.0, 16);
    elevations.erase(elevations.begin() + 5);
    elevations.erase(elevations.begin());
    elevations.pop_back();
    const auto vlp16 = ringsFromElevations(cloudOf(elevations).points);
    ASSERT_TRUE(vlp16);
    EXPECT_EQ(vlp16->rings, 16) << "a known sensor: also the lowest and the highest";
    EXPECT_EQ(*std::min_element(vlp16->ring.begin(), vlp16->ring.end()), 1);

    elevations = evenSteps(-20.0, 1.5, 24);
    elevations.erase(elevations.begin() + 10);
    const auto other = ringsFromElevations(cloudOf(elevations).points);
    ASSERT_TRUE(other);
    EXPECT_EQ(other->rings, 24);
}

TEST(ElevationRings, AreNotMadeUp) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal(0.0f, 1.0f);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    Points ball, stack;
    for (int k = 0; k < 30'000; ++k) {
        ball.emplace_back(normal(random), normal(random), normal(random));
        stack.emplace_back(30.0f * uniform(random), 30.0f * uniform(random), 2.0f * uniform(random));
    }
    EXPECT_FALSE(ringsFromElevations(ball));
    EXPECT_FALSE(ringsFromElevations(stack));
    EXPECT_FALSE(ringsFromElevations(Points(ball.begin(), ball.begin() + 300)));
    EXPECT_FALSE(ringsFromElevations({}));
    Cloud moved = cloudOf(evenSteps(-15.0, 2.0, 16));
    for (std::size_t i = 0; i < moved.points.size(); ++i)
        moved.points[i].z() += 1.0f * static_cast<float>(i) / static_cast<float>(moved.points.size());
    EXPECT_FALSE(ringsFromElevations(moved.points)) << "corrected for a motion of the sensor";
    EXPECT_FALSE(ringsFromElevations(cloudOf(evenSteps(-1.0, 1.0, 3)).points)) << "three are no proof";
}

/// Point maps as MRPT has had them; what they have in common is left out.
struct Map2_5 {
    std::size_t size() const { return 2; }
};
struct Map2_11 : Map2_5 {
    std::vector<float> intensities = {0.1F, 0.2F}, times = {0.0F, 0.05F};
    std::vector<std::uint16_t> rings = {3, 4};
    const std::vector<float>* getPointsBufferRef_intensity() const { return &intensities; }
    const std::vector<float>* getPointsBufferRef_timestamp() const { return &times; }
    const std::vector<std::uint16_t>* getPointsBufferRef_ring() const { return &rings; }
};
struct Map2_15 : Map2_11 {
    std::vector<std::uint16_t> named_rings = {5, 6};
    const std::vector<float>* getPointsBufferRef_float_field(const std::string& name) const {
        return name == "t" ? &times : name == "intensity" ? &intensities : nullptr;
    }
    const std::vector<std::uint16_t>* getPointsBufferRef_uint_field(const std::string& name) const {
        return name == "ring" ? &named_rings : nullptr;
    }
};

TEST(PointFields, AreReadFromTheMapsOfAnyMrpt) {
    const PointFields none = pointFieldsOf(Map2_5());
    EXPECT_TRUE(none.ring.empty() && none.time.empty() && none.intensity.empty());
    const PointFields all = pointFieldsOf(Map2_11());
    EXPECT_THAT(all.ring, testing::ElementsAre(3, 4));
    EXPECT_THAT(all.time, testing::ElementsAre(0.0F, 0.05F));
    EXPECT_THAT(all.intensity, testing::ElementsAre(0.1F, 0.2F));
    EXPECT_THAT(pointFieldsOf(Map2_15()).ring, testing::ElementsAre(5, 6));
    EXPECT_THAT(pointFieldsOf(Map2_15()).time, testing::ElementsAre(0.0F, 0.05F));
    Map2_11 too_few;
    too_few.rings = {1};
    EXPECT_TRUE(pointFieldsOf(too_few).ring.empty()) << "a field that some points lack";
}

mrpt::obs::CObservationPointCloud observationOf(const Points& points) {
    mrpt::obs::CObservationPointCloud observation;
    auto map = mrpt::maps::CSimplePointsMap::Create();
    for (const auto& p : points) map->insertPoint(p.x(), p.y(), p.z());
    observation.pointcloud = map;
    return observation;
}

TEST(ElevationRings, AreThoseOfATiltedSensorToo) {
    const std::vector<double> vlp32c = {-25.0,  -15.639, -11.31, -8.843, -7.254, -6.148, -5.333, -4.667,
                                        -4.0,   -3.667,  -3.333, -3.0,   -2.667, -2.333, -2.0,   -1.667,
                                        -1.333, -1.0,    -0.667, -0.333, 0.0,    0.333,  0.667,  1.0,
                                        1.333,  1.667,   2.333,  3.333,  4.667,  7.0,    10.333, 15.0};
    for (const auto& elevations : {evenSteps(-15.0, 2.0, 16), evenSteps(-92.0 / 3.0, 4.0 / 3.0, 32), vlp32c,
                                   evenSteps(-16.0, 1.0, 32), evenSteps(22.5, -45.0 / 31, 32)}) {
        const Cloud cloud = cloudOf(elevations);
        auto observation = observationOf(cloud.points);
        observation.sensorPose = mrpt::poses::CPose3D(1, 0, 1.8, 0.3, 0.5, M_PI);
        DecodeStats stats;
        const PointCloud found = toPointCloud(observation, {0, 0, 0.0, 200.0}, &stats);
        std::vector<std::uint16_t> upwards = cloud.ring;
        if (elevations.front() > elevations.back())
            for (auto& ring : upwards) ring = static_cast<std::uint16_t>(elevations.size() - 1 - ring);
        EXPECT_EQ(found.ring, upwards);
        EXPECT_EQ(found.view.rings, static_cast<int>(elevations.size()));
        EXPECT_FALSE(stats.without_rings);
        const PointCloud few = toPointCloud(observation, {8, 0, 0.0, 200.0});
        EXPECT_EQ(few.size(), 8u * 180) << "so planes can be chosen";
    }
}

TEST(ElevationRings, ThatAreNotThereAreTold) {
    Points ball;
    std::mt19937 random(5);
    std::normal_distribution<float> normal(0.0f, 3.0f);
    for (int k = 0; k < 3000; ++k) ball.emplace_back(normal(random), normal(random), normal(random));
    const auto observation = observationOf(ball);
    DecodeStats stats;
    EXPECT_TRUE(toPointCloud(observation, {0, 0, 0.0, 200.0}, &stats).ring.empty());
    EXPECT_TRUE(stats.without_rings);
    EXPECT_THROW(toPointCloud(observation, {8, 0, 0.0, 200.0}), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles
