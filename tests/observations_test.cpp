// SPDX-License-Identifier: BSD-3-Clause
// Recorded scans against MRPT's own decoder, and scans that come without packets.
#include "lidar_obstacles/mrpt_bridge/observations.h"

#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationComment.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "mrpt_bridge/input/point_fields.h"
#include "support/test_data.h"
#include "support/velodyne_packets.h"

namespace lidar_obstacles {
namespace {

using namespace test;

const SensorParams kWide{0, 0, 0.0, 200.0};  // all planes, no range limits
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <class Observation>
std::vector<std::shared_ptr<Observation>> readAll(const std::string& path) {
    std::vector<std::shared_ptr<Observation>> scans;
    const auto source = openScanSource(path);
    while (const auto item = source->next())
        if (auto scan = std::dynamic_pointer_cast<Observation>(item->observation)) scans.push_back(scan);
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
    return scans;
}

VelodyneScan wide(VelodyneScan scan) {
    scan.minRange = 0.0;
    scan.maxRange = 200.0;
    scan.sensorPose = mrpt::poses::CPose3D();
    return scan;
}

/// The scan with the returns MRPT does not decode taken out.
VelodyneScan firstHalfOfBlocks(VelodyneScan scan) {
    for (auto& packet : scan.scan_packets)
        for (int b = 0; b < 12; ++b)
            for (int k = 16; k < 32; ++k) setReturn(packet, b, k, 0, 0);
    return scan;
}

/// The scan with the second 16 returns of each block in place of the first.
VelodyneScan secondHalfOfBlocks(VelodyneScan scan) {
    for (auto& packet : scan.scan_packets)
        for (int b = 0; b < 12; ++b) std::memmove(bytes(packet) + 100 * b + 4, bytes(packet) + 100 * b + 52, 48);
    return scan;
}

std::size_t mrptCount(VelodyneScan scan) {
    VelodyneScan::TGeneratePointCloudParameters params;
    params.minDistance = 0.0f;
    scan.generatePointCloud(params);
    return scan.point_cloud.size();
}

/// Holds our decoding against MRPT's, return by return. MRPT rounds azimuths to 0.01 deg, its table is good for
/// 0.005 deg, and it takes the turning speed from one packet where we take it from the whole scan (0.01 deg).
void expectSameAsMrpt(const VelodyneScan& recorded) {
    VelodyneScan scan = firstHalfOfBlocks(wide(recorded));
    const PointCloud ours = toPointCloud(scan, kWide);
    VelodyneScan::TGeneratePointCloudParameters params;
    params.minDistance = 0.0f;
    scan.generatePointCloud(params);
    const auto& theirs = scan.point_cloud;
    ASSERT_EQ(ours.size(), theirs.size());
    for (std::size_t i = 0; i < ours.size(); ++i) {
        const Eigen::Vector3f p(theirs.x[i], theirs.y[i], theirs.z[i]);
        const float angle = 0.025f * static_cast<float>(M_PI) / 180.0f;
        ASSERT_LT((ours.xyz[i] - p).norm(), p.norm() * angle + 1e-3f) << "return " << i;
        ASSERT_NEAR(ours.intensity[i] * 255.0f, static_cast<float>(theirs.intensity[i]), 1e-3f);
    }
}

TEST(Vlp16Sample, AllReturnsAreDecoded) {
    LIDAR_OBSTACLES_NEED(path, mrptDataset("test_velodyne_VLP16.rawlog"));
    const auto scans = readAll<VelodyneScan>(path);
    ASSERT_EQ(scans.size(), 1u);
    const VelodyneScan scan = wide(*scans[0]);
    EXPECT_EQ(toPointCloud(scan, kWide).size(), 22'591u);
    EXPECT_EQ(mrptCount(scan) + mrptCount(secondHalfOfBlocks(scan)), 22'591u) << "MRPT, half by half";
    DecodeStats stats;
    toPointCloud(scan, kWide, &stats);
    EXPECT_EQ(stats.packets, 75);
    EXPECT_EQ(stats.damaged_blocks + stats.retimed_packets, 0);
}

TEST(Vlp16Sample, FirstFiringsEqualMrpts) {
    LIDAR_OBSTACLES_NEED(path, mrptDataset("test_velodyne_VLP16.rawlog"));
    expectSameAsMrpt(*readAll<VelodyneScan>(path).at(0));
}

TEST(Vlp16Sample, TheViewListsNearlyAllReturns) {
    LIDAR_OBSTACLES_NEED(path, mrptDataset("test_velodyne_VLP16.rawlog"));
    const PointCloud cloud = toPointCloud(wide(*readAll<VelodyneScan>(path).at(0)), kWide);
    const auto listed = std::count_if(cloud.view.index.begin(), cloud.view.index.end(), [](int i) { return i >= 0; });
    EXPECT_GT(static_cast<double>(listed), 0.99 * static_cast<double>(cloud.size()));
    EXPECT_NEAR(cloud.view.columns, 1810, 2) << "75 packets of 24 firings turn 357.85 deg";
}

TEST(Calibration, DistanceAndHorizontalCorrectionsAreAppliedAsMrptDoes) {
    LIDAR_OBSTACLES_NEED(path, mrptDataset("test_velodyne_VLP16.rawlog"));
    VelodyneScan scan = *readAll<VelodyneScan>(path).at(0);
    for (auto& laser : scan.calibration.laser_corrections) {
        laser.horizontalOffsetCorrection = 0.03;
        laser.distanceCorrection = 0.12;
    }
    expectSameAsMrpt(scan);
}

TEST(Hdl32Capture, All32LasersAreDecodedAndTheFirst16EqualMrpts) {
    LIDAR_OBSTACLES_NEED(path, labelledData("velodyne_hdl32.pcap"));
    const auto scans = readAll<VelodyneScan>(path);
    ASSERT_EQ(scans.size(), 4u);
    expectSameAsMrpt(*scans[1]);
    const PointCloud cloud = toPointCloud(wide(*scans[1]), kWide);
    std::size_t nonzero = 0;
    for (const auto& packet : scans[1]->scan_packets)
        for (const auto& block : packet.blocks)
            nonzero +=
                static_cast<std::size_t>(std::count_if(std::begin(block.laser_returns), std::end(block.laser_returns),
                                                       [](const auto& r) { return r.distance() != 0; }));
    EXPECT_EQ(cloud.size(), nonzero);
    EXPECT_NEAR(cloud.view.columns, 2400, 10);
    EXPECT_EQ(*std::max_element(cloud.ring.begin(), cloud.ring.end()), 31);
}

TEST(DualCapture, PairsOfEqualDistanceCountOnce) {
    LIDAR_OBSTACLES_NEED(path, labelledData("velodyne_vlp16_dual.pcap"));
    const auto scans = readAll<VelodyneScan>(path);
    ASSERT_GE(scans.size(), 2u);
    const VelodyneScan scan = wide(*scans[1]);
    std::size_t expected = 0;
    for (const auto& packet : scan.scan_packets)
        for (int b = 0; b < 12; b += 2)
            for (int k = 0; k < 32; ++k) {
                const int last = packet.blocks[b].laser_returns[k].distance();
                const int strongest = packet.blocks[b + 1].laser_returns[k].distance();
                expected += static_cast<std::size_t>(last != 0) + (strongest != 0 && strongest != last);
            }
    EXPECT_EQ(toPointCloud(scan, kWide).size(), expected);
    EXPECT_EQ(scan.scan_packets.at(0).laser_return_mode, 0x39);
    expectSameAsMrpt(scan);
}

/// A scan with `point_cloud` and no packets: n points per ring on a circle of 10 m around the sensor.
VelodyneScan ringsOfPoints(int rings, int per_ring) {
    VelodyneScan scan;
    scan.sensorPose = mrpt::poses::CPose3D(0, 0, 2.0, 0, 0, 0);
    scan.timestamp = mrpt::Clock::fromDouble(1000.0);
    for (int i = 0; i < per_ring; ++i)
        for (int ring = 0; ring < rings; ++ring) {
            const double azimuth = 2.0 * M_PI * i / per_ring;
            scan.point_cloud.x.push_back(static_cast<float>(10.0 * std::cos(azimuth)));
            scan.point_cloud.y.push_back(static_cast<float>(10.0 * std::sin(azimuth)));
            scan.point_cloud.z.push_back(static_cast<float>(ring) * 0.1f);
            scan.point_cloud.intensity.push_back(102);
            scan.point_cloud.laser_id.push_back(static_cast<std::int16_t>(ring));
        }
    return scan;
}

TEST(PointCloudScan, LaserIdBecomesTheRingAndTheViewHasOneColumnPerStep) {
    const PointCloud cloud = toPointCloud(ringsOfPoints(16, 900), kWide);
    ASSERT_EQ(cloud.size(), 16u * 900);
    EXPECT_EQ(cloud.view.rings, 16);
    EXPECT_NEAR(cloud.view.columns, 900, 1);
    EXPECT_TRUE(cloud.time_offset.empty());
    EXPECT_FLOAT_EQ(cloud.intensity[0], 0.4f);
    EXPECT_FLOAT_EQ(cloud.xyz[5].z(), 2.5f);
    EXPECT_EQ(cloud.ring[5], 5);
    for (std::size_t i = 16; i < cloud.size(); ++i) {  // the points turn left, columns turn right
        const int step = cloud.view.wrap(cloud.view.column_of[i - 16] - cloud.view.column_of[i]);
        ASSERT_LE(step, 2) << i;
    }
}

TEST(PointCloudScan, PlanesComeFromTheHighestLaserIdOrTheParameters) {
    SensorParams params = kWide;
    params.planes = 4;
    EXPECT_EQ(toPointCloud(ringsOfPoints(16, 90), params).size(), 4u * 90);
    EXPECT_THROW(toPointCloud(ringsOfPoints(15, 90), params), std::invalid_argument);
    params.rings = 16;
    const PointCloud cloud = toPointCloud(ringsOfPoints(15, 90), params);  // the uppermost plane saw nothing
    EXPECT_EQ(cloud.size(), 4u * 90);
    EXPECT_FLOAT_EQ(cloud.xyz[0].z(), 2.1f) << "(k - 1) / 2 = 1 is the first ring kept";
    params.rings = 8;
    EXPECT_THROW(toPointCloud(ringsOfPoints(16, 90), params), std::invalid_argument);
}

TEST(PointCloudScan, NonFiniteZeroAndFarPointsAreDropped) {
    VelodyneScan scan = ringsOfPoints(16, 90);
    scan.point_cloud.x[0] = kNan;
    scan.point_cloud.z[1] = std::numeric_limits<float>::infinity();
    scan.point_cloud.x[2] = scan.point_cloud.y[2] = scan.point_cloud.z[2] = 0.0f;
    scan.point_cloud.x[3] = 500.0f;
    scan.minRange = 0.0;
    EXPECT_EQ(toPointCloud(scan, kWide).size(), 16u * 90 - 4);
}

TEST(PointCloudScan, TimesOfAnotherClockAreLeftOut) {
    VelodyneScan scan = ringsOfPoints(16, 90);
    for (std::size_t i = 0; i < scan.point_cloud.x.size(); ++i)
        scan.point_cloud.timestamp.push_back(mrpt::Clock::fromDouble(1000.0 + 1e-4 * static_cast<double>(i / 16)));
    DecodeStats stats;
    EXPECT_EQ(toPointCloud(scan, kWide, &stats).time_offset.size(), 16u * 90);
    EXPECT_FALSE(stats.times_left_out);
    scan.point_cloud.timestamp.back() = mrpt::Clock::fromDouble(1'700'000'000.0);
    const PointCloud cloud = toPointCloud(scan, kWide, &stats);
    EXPECT_TRUE(cloud.time_offset.empty());
    EXPECT_TRUE(stats.times_left_out);
    EXPECT_EQ(cloud.size(), 16u * 90);
}

TEST(PointCloudScan, WithReturnsBeforeItsStampIsStampedByTheFirst) {
    VelodyneScan scan = ringsOfPoints(16, 90);
    for (std::size_t i = 0; i < scan.point_cloud.x.size(); ++i)
        scan.point_cloud.timestamp.push_back(mrpt::Clock::fromDouble(1000.0 + 1e-3 * static_cast<double>(i / 16)));
    const PointCloud by_first = toPointCloud(scan, kWide);
    EXPECT_NEAR(by_first.timestamp, 1000.0, 1e-6);
    for (const double stamp : {1000.05, 1000.089, 1000.1}) {  // in the middle of the turn, at its end, when it came
        scan.timestamp = mrpt::Clock::fromDouble(stamp);
        DecodeStats stats;
        const PointCloud cloud = toPointCloud(scan, kWide, &stats);
        EXPECT_FALSE(stats.times_left_out);
        EXPECT_NEAR(cloud.timestamp, 1000.0, 1e-6) << stamp;
        ASSERT_EQ(cloud.time_offset.size(), by_first.time_offset.size());
        for (std::size_t i = 0; i < cloud.size(); ++i)
            ASSERT_NEAR(cloud.time_offset[i], by_first.time_offset[i], 1e-6) << stamp;
    }
    scan.timestamp = mrpt::Clock::fromDouble(999.99);  // its first firing met nothing
    EXPECT_NEAR(toPointCloud(scan, kWide).timestamp, 999.99, 1e-6);
    EXPECT_NEAR(toPointCloud(scan, kWide).time_offset[0], 0.01, 1e-6);
}

TEST(PointCloudScan, FieldsThatContradictEachOtherAreRefused) {
    VelodyneScan scan = ringsOfPoints(16, 90);
    scan.point_cloud.laser_id[7] = -1;
    EXPECT_THROW(toPointCloud(scan, kWide), std::runtime_error);
    scan.point_cloud.laser_id[7] = 30'000;
    EXPECT_THROW(toPointCloud(scan, kWide), std::runtime_error);
    scan.point_cloud.laser_id.resize(100);
    EXPECT_THROW(toPointCloud(scan, kWide), std::runtime_error);
    scan.point_cloud.laser_id.clear();
    EXPECT_EQ(toPointCloud(scan, kWide).view.rings, 16) << "recovered from the elevations";
    scan.point_cloud.clear();
    EXPECT_TRUE(toPointCloud(scan, kWide).empty());
}

TEST(Kitti64, DecimationTo16KeepsTheSecondOfEveryFourRings) {
    LIDAR_OBSTACLES_NEED(path, labelledData("kitti_0048_64.rawlog"));
    const auto scan = readAll<VelodyneScan>(path).at(0);
    SensorParams params = kWide;
    params.planes = 16;
    const PointCloud all = toPointCloud(*scan, kWide), few = toPointCloud(*scan, params);
    std::vector<Eigen::Vector3f> expected;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (all.ring[i] % 4 == 1) expected.push_back(all.xyz[i]);
    EXPECT_EQ(few.xyz, expected);
    EXPECT_EQ(few.view.rings, 16);
    EXPECT_NEAR(few.view.columns, 2000, 100) << "an HDL-64 at 10 Hz steps by about 0.18 deg";
}

TEST(PointCloudObservation, PointsAreTakenWithIntensityAndWithoutRings) {
    mrpt::obs::CObservationPointCloud scan;
    EXPECT_TRUE(toPointCloud(scan, kWide).empty()) << "an observation without a cloud";
    auto points = makeIntensityMap(3);
    points->setPointFast(0, 1.0f, 2.0f, 3.0f);
    points->setPointFast(1, kNan, 2.0f, 3.0f);
    points->setPointFast(2, 0.0f, 0.0f, 0.0f);
    setIntensity(*points, 0, 0.25f);
    scan.pointcloud = points;
    scan.sensorPose = mrpt::poses::CPose3D(10, 0, 0, M_PI / 2, 0, 0);
    const PointCloud cloud = toPointCloud(scan, kWide);
    ASSERT_EQ(cloud.size(), 1u);
    EXPECT_TRUE(cloud.xyz[0].isApprox(Eigen::Vector3f(8.0f, 1.0f, 3.0f)));
    EXPECT_FLOAT_EQ(cloud.intensity.at(0), 0.25f);
    EXPECT_TRUE(cloud.view.empty() && cloud.ring.empty() && cloud.time_offset.empty());

    SensorParams params = kWide;
    params.planes = 8;
    EXPECT_THROW(toPointCloud(scan, params), std::invalid_argument);
}

TEST(RotatingScan, ShowsTheFirstFiringsOfTheSameMoment) {
    LIDAR_OBSTACLES_NEED(path, mrptDataset("test_velodyne_VLP16.rawlog"));
    const VelodyneScan packets = wide(*readAll<VelodyneScan>(path).at(0));
    mrpt::obs::CObservationRotatingScan image;
    image.fromVelodyne(packets);
    const PointCloud from_image = toPointCloud(image, kWide);
    const PointCloud from_packets = toPointCloud(firstHalfOfBlocks(packets), kWide);
    ASSERT_EQ(from_image.size(), from_packets.size());
    EXPECT_EQ(from_image.ring, from_packets.ring);
    for (std::size_t i = 0; i < from_image.size(); ++i) {
        const auto &p = from_image.xyz[i], &q = from_packets.xyz[i];
        ASSERT_NEAR(p.norm(), q.norm(), 1e-3f);
        // The image has one azimuth per firing, and spreads them evenly: half a degree apart at most.
        ASSERT_LT((p - q).norm(), 0.5f * static_cast<float>(M_PI) / 180.0f * q.norm()) << i;
    }
    EXPECT_EQ(from_image.view.rings, 16);
    EXPECT_NEAR(from_image.view.columns, 905, 2);
    for (const char* name : {"vlp16", "Velodyne VLP-16", "puck hi-res"}) {
        image.lidarModel = name;
        EXPECT_EQ(toPointCloud(image, kWide).size(), from_packets.size()) << name;
    }
    image.sweepDuration = 1e9;
    DecodeStats stats;
    const mrpt::obs::CObservation& any = image;
    EXPECT_TRUE(toPointCloud(any, kWide, &stats)->time_offset.empty()) << "no turn takes so long";
    EXPECT_TRUE(stats.times_left_out);
    image.lidarModel = "other";
    EXPECT_THROW(toPointCloud(image, kWide), std::runtime_error);
}

TEST(Dispatch, OnlyLidarScansGiveClouds) {
    const mrpt::obs::CObservationComment comment;
    EXPECT_FALSE(isLidarScan(comment));
    EXPECT_EQ(toPointCloud(static_cast<const mrpt::obs::CObservation&>(comment), kWide), std::nullopt);
    const VelodyneScan scan = ringsOfPoints(4, 90);
    EXPECT_TRUE(isLidarScan(scan));
    EXPECT_EQ(toPointCloud(static_cast<const mrpt::obs::CObservation&>(scan), kWide)->size(), 360u);
}

/// Five rays over 180 degrees, counter-clockwise from the right: 2, 3, 4, 5, 6 m.
mrpt::obs::CObservation2DRangeScan planarScan() {
    mrpt::obs::CObservation2DRangeScan scan;
    scan.aperture = static_cast<float>(M_PI);
    scan.rightToLeft = true;
    scan.maxRange = 20.0F;
    scan.sensorPose = mrpt::poses::CPose3D(0.5, 0.0, 0.3, 0.0, 0.0, 0.0);
    scan.resizeScan(5);
    for (int k = 0; k < 5; ++k) {
        scan.setScanRange(static_cast<std::size_t>(k), 2.0F + static_cast<float>(k));
        scan.setScanRangeValidity(static_cast<std::size_t>(k), true);
    }
    return scan;
}

TEST(PlanarScan, ItsRaysLieInOnePlaneAtTheSensorsPlace) {
    const PointCloud cloud = toPointCloud(planarScan(), SensorParams{});
    ASSERT_EQ(cloud.size(), 5U);
    EXPECT_NEAR((cloud.xyz[0] - Eigen::Vector3f(0.5F, -2.0F, 0.3F)).norm(), 0.0F, 1e-5F);
    EXPECT_NEAR((cloud.xyz[2] - Eigen::Vector3f(4.5F, 0.0F, 0.3F)).norm(), 0.0F, 1e-5F);
    EXPECT_NEAR((cloud.xyz[4] - Eigen::Vector3f(0.5F, 6.0F, 0.3F)).norm(), 0.0F, 1e-5F);
    EXPECT_EQ(cloud.view.rings, 1);
}

TEST(PlanarScan, ClockwiseScansRunTheOtherWayAndInvalidRaysAreLeftOut) {
    mrpt::obs::CObservation2DRangeScan scan = planarScan();
    scan.rightToLeft = false;
    scan.setScanRangeValidity(1, false);
    scan.setScanRange(3, std::numeric_limits<float>::quiet_NaN());
    const PointCloud cloud = toPointCloud(scan, SensorParams{});
    ASSERT_EQ(cloud.size(), 3U);
    EXPECT_NEAR((cloud.xyz[0] - Eigen::Vector3f(0.5F, 2.0F, 0.3F)).norm(), 0.0F, 1e-5F);
}

TEST(PlanarScan, OnePlaneCannotBeDecimatedAndABadApertureIsRefused) {
    SensorParams params;
    params.planes = 8;
    EXPECT_THROW(toPointCloud(planarScan(), params), std::invalid_argument);
    mrpt::obs::CObservation2DRangeScan scan = planarScan();
    scan.aperture = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(toPointCloud(scan, SensorParams{}), std::runtime_error);
}

}  // namespace
}  // namespace lidar_obstacles
