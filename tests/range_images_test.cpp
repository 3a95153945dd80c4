// SPDX-License-Identifier: BSD-3-Clause
// Range images of sensors of several makers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationRotatingScan.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles {
namespace {

const SensorParams kWide{0, 0, 0.0, 200.0};  // all planes, no range limits

/// A turn of 360 firings that all see something 20 m away.
mrpt::obs::CObservationRotatingScan imageOf(const std::string& model, int rows) {
    mrpt::obs::CObservationRotatingScan image;
    image.lidarModel = model;
    image.rowCount = static_cast<std::uint16_t>(rows);
    image.columnCount = 360;
    image.rangeImage.resize(rows, 360);
    image.rangeImage.fill(5000);
    image.rangeResolution = 0.004;
    image.startAzimuth = 0.0;
    image.azimuthSpan = -2.0 * M_PI;
    image.sweepDuration = 0.1;
    image.minRange = 0.0;
    image.sensorPose = mrpt::poses::CPose3D(0, 0, 0, 0, 0, 0);
    return image;
}

struct RowsOfModel {
    const char* model;
    int rows;
    double lowest, highest;  ///< [deg]
};

TEST(RotatingScan, OfOtherMakersLooksWhereTheirManualsSay) {
    for (const RowsOfModel& m :
         {RowsOfModel{"RS-LiDAR-16", 16, -15.0, 15.0}, RowsOfModel{"Hesai Pandar XT-32", 32, -16.0, 15.0},
          RowsOfModel{"hesai_xt16", 16, -15.0, 15.0}, RowsOfModel{"VLP-32C", 32, -25.0, 15.0}}) {
        const PointCloud cloud = toPointCloud(imageOf(m.model, m.rows), kWide);
        ASSERT_EQ(cloud.size(), 360U * static_cast<unsigned>(m.rows)) << m.model;
        EXPECT_EQ(cloud.view.rings, m.rows);
        std::vector<double> elevation(static_cast<std::size_t>(m.rows), 90.0);
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            EXPECT_NEAR(cloud.xyz[i].norm(), 20.0, 1e-3);
            elevation[cloud.ring[i]] = std::asin(cloud.xyz[i].z() / 20.0) * 180.0 / M_PI;
        }
        EXPECT_TRUE(std::is_sorted(elevation.begin(), elevation.end())) << m.model << ": rings count upwards";
        EXPECT_NEAR(elevation.front(), m.lowest, 1e-3) << m.model;
        EXPECT_NEAR(elevation.back(), m.highest, 1e-3) << m.model;
    }
}

TEST(RotatingScan, LasersBesideTheAzimuthOfTheirFiringAreSeenBesideIt) {
    const PointCloud cloud = toPointCloud(imageOf("VLP-32C", 32), kWide);
    for (std::size_t i = 0; i < cloud.size(); ++i) {  // columns lie half a degree apart from none of these places
        const double turned = -std::atan2(cloud.xyz[i].y(), cloud.xyz[i].x()) * 180.0 / M_PI;
        EXPECT_LE(std::abs(std::remainder(turned - cloud.view.column_of[i], 360.0)), 0.51) << i;
    }
}

TEST(RotatingScan, TurnsAsItsSpanSays) {
    auto image = imageOf("XT16", 16);
    for (const double span : {2.0 * M_PI, -2.0 * M_PI}) {  // counter-clockwise, clockwise
        image.azimuthSpan = span;
        image.rangeImage.fill(0);
        image.rangeImage(7, 90) = 5000;  // a quarter turn on
        const PointCloud cloud = toPointCloud(image, kWide);
        ASSERT_EQ(cloud.size(), 1U);
        EXPECT_NEAR(cloud.xyz[0].y(), span > 0.0 ? 20.0 : -20.0, 0.01);
    }
}

TEST(RotatingScan, HasTimesWhereItTellsHowLongItTookOnly) {
    auto image = imageOf("XT16", 16);
    DecodeStats stats;
    const PointCloud timed = toPointCloud(image, kWide, &stats);
    ASSERT_EQ(timed.time_offset.size(), timed.size());
    EXPECT_NEAR(timed.time_offset.back(), 0.1 * 359 / 360, 1e-6);
    EXPECT_FALSE(stats.times_left_out);
    image.sweepDuration = 0.0;  // as MRPT leaves it where nobody knows
    EXPECT_TRUE(toPointCloud(image, kWide, &stats).time_offset.empty()) << "they were not all at one time";
    EXPECT_FALSE(stats.times_left_out) << "there were none";
    for (const double wrong : {-0.1, -2.0, 1.5}) {  // the sense of the turn is that of the span
        image.sweepDuration = wrong;
        const PointCloud cloud = toPointCloud(image, kWide, &stats);
        EXPECT_TRUE(cloud.time_offset.empty()) << wrong;
        EXPECT_TRUE(stats.times_left_out) << wrong;
        EXPECT_EQ(cloud.xyz, timed.xyz) << wrong;
    }
}

TEST(RotatingScan, OfAnUnknownModelNamesThoseThatAreKnown) {
    try {
        toPointCloud(imageOf("OS1-64", 64), kWide);
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), testing::AllOf(testing::HasSubstr("OS1-64"), testing::HasSubstr("XT32")));
    }
    EXPECT_THROW(toPointCloud(imageOf("XT32", 16), kWide), std::runtime_error) << "16 rows of 32";
}

}  // namespace
}  // namespace lidar_obstacles
