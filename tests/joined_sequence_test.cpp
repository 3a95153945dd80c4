// SPDX-License-Identifier: BSD-3-Clause
// Several lidars as one, from scan to scan: poses, matching, tracks, pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include "lidar_obstacles/clustering.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/joined_cloud.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "mrpt_bridge/output/scene_carpet.h"
#include "sequence/match_points.h"
#include "sequence/track_cost.h"
#include "support/rawlog_files.h"
#include "support/synthetic_scene.h"
#include "support/temp_folder.h"
#include "support/track_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

PointCloud castFrom(const World& world, const Eigen::Vector3d& position) {
    Sensor sensor;
    sensor.position = position;
    return castRays(world, sensor).cloud;
}

/// Everything off that would use poses for one lidar alone.
DetectorParams withoutTracks() {
    DetectorParams params;
    params.tracking.enabled = false;
    params.ego.source = "matching";
    return params;
}

TEST(JoinedSequence, UsesPosesWhereOneLidarWouldNot) {
    EXPECT_FALSE(usesPoses(withoutTracks()));
    EXPECT_TRUE(usesPoses(withoutTracks(), true));
}

TEST(JoinedSequence, IsMatchedWhereNothingElseWouldUseThePoses) {
    const PointCloud one = castFrom(street(), {1.0, 0.0, 1.8});
    ObstacleDetector detector(withoutTracks());
    EXPECT_FALSE(detector.process(one).match);
    EXPECT_TRUE(detector.process(joinedCloud({one, castFrom(street(), {-1.0, 0.0, 1.0})})).match);
}

TEST(JoinedSequence, EachSensorIsMatchedAsFarAsItSees) {
    World world = flatWorld();
    world.boxes = {boxAt(160.0, 0.0, 0.0, {2.0, 40.0, 6.0}), boxAt(-160.0, 0.0, 0.0, {2.0, 40.0, 6.0})};
    const PointCloud front = castFrom(world, {75.0, 0.0, 1.8}), rear = castFrom(world, {-75.0, 0.0, 1.8});
    const auto far = [](const PointCloud& cloud) {
        const auto points = matchPoints(cloud, {}, 0.5f).points;
        return std::count_if(points.begin(), points.end(), [](const MatchPoint& m) {
            return std::abs(m.p.x()) > 150.0f && m.tangent != Eigen::Vector2f::Zero();
        });
    };
    ASSERT_GT(far(front), 20);
    EXPECT_NEAR(static_cast<double>(far(joinedCloud({front, rear}))), static_cast<double>(far(front) + far(rear)), 4.0);
}

TEST(JoinedSequence, PosesAreReadUpToTheEndOfTheLastScan) {
    const TempFolder folder;
    Objects objects;
    for (int k = 0; k < 3; ++k) {
        objects.push_back(scanLabelled("front", 10.0 + 0.2 * k));
        objects.push_back(scanLabelled("rear", 10.09 + 0.2 * k));
        for (int p = 0; p < 10; ++p) {
            auto pose = std::make_shared<mrpt::obs::CObservationRobotPose>();
            pose->sensorLabel = "pose";
            pose->timestamp = mrpt::Clock::fromDouble(10.0 + 0.2 * k + 0.02 * p);
            objects.push_back(pose);
        }
    }
    writeRawlog(folder.file("drive.rawlog"), objects, false);
    JoinedLidars joined(openScanSource(folder.file("drive.rawlog")), "front,rear");
    double newest = 0.0;
    PoseFeed feed(joined, {EgoKind::Pose, "pose"}, [&](const StampedPose& pose) { newest = pose.time; });
    const auto item = feed.next();
    ASSERT_TRUE(item && item->beside.size() == 1);
    EXPECT_GE(newest, 10.09 + kLongestScan) << "when the rear one's turn has ended";
}

TEST(JoinedSequence, ABoxAndItsTrackAreComparedAsTheSensorSeesThemThatSawIt) {
    const TrackingParams params;
    const Eigen::Vector2d middle(0.0, 0.0), own(0.0, 6.0);
    Detector detector;
    SeenBox seen = detector.see(carAt({8.0, 8.0, 0.3}), {}, 10.0);
    seen.sensor = own;
    const PlacedBox box = placeBox(seen, own, params);
    Track track;
    track.begin(0, box);
    const Body moved = carAt({8.9, 8.4, 0.3});
    SeenBox later = detector.see(moved, {}, 10.1);
    later.sensor = own;
    const PlacedBox next = placeBox(later, own, params);
    EXPECT_DOUBLE_EQ(costOf(track, expect(track, 10.1, middle), next, params),
                     costOf(track, expect(track, 10.1, own), next, params));
}

TEST(JoinedSequence, ThePictureOfTheClosingIsWhatTheClusteringDoes) {
    OccupancyGrid grid;
    grid.origin = {-60.0, -5.0};
    grid.resolution = 0.1;
    grid.width = 1200;
    grid.height = 100;
    const std::int32_t row = 50 * grid.width;
    grid.occupied = {row + 1100, row + 1105};  // 50 m ahead
    ClusteringParams params;
    params.closing = 0.1;
    params.closing_per_metre = 0.02;
    const auto filled = [&](const std::vector<SensorRays>& sensors) {
        cv::Mat1b texels = emptyTexels(grid, 1);
        markClosing(grid, {sensors, params}, 1, texels);
        return cv::countNonZero(texels == kFilled);
    };
    SensorRays near, far;
    near.origin = {50.0f, 1.0f, 1.0f};
    far.origin = {-50.0f, 0.0f, 1.0f};
    EXPECT_EQ(filled({near, far}), 0) << "the gap is seen from nearby";
    EXPECT_EQ(filled({far}), 4);
}

}  // namespace
}  // namespace lidar_obstacles
