// SPDX-License-Identifier: BSD-3-Clause
// Motion from the scans themselves, against motion that is known.
#include "lidar_obstacles/scan_matching.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/ground.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

constexpr double kStart = 1000.0;  // [s]
constexpr double kTurn = 0.1;      // from scan to scan [s]

/// Where the vehicle is on flat ground.
struct Place {
    double x = 0.0, y = 0.0, yaw = 0.0;

    Eigen::Isometry3d pose() const {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        T.translation() = Eigen::Vector3d(x, y, 0.0);
        return T;
    }
};

/// Driving on with that speed [m/s] and rate of turn [rad/s].
Place driven(double speed, double turn, double time) {
    if (turn == 0.0) return {speed * time, 0.0, 0.0};
    return {speed / turn * std::sin(turn * time), speed / turn * (1.0 - std::cos(turn * time)), turn * time};
}

/// Houses with gaps, posts and parked cars on both sides of a road, 150 m of it.
std::vector<OrientedBox> road() {
    std::vector<OrientedBox> boxes;
    for (int k = 0; k < 12; ++k) {
        boxes.push_back(test::boxAt(-30.0 + 14.0 * k, 11.0 + 0.3 * (k % 3), 0, {10.0, 3.0, 5.0}));
        boxes.push_back(test::boxAt(-26.0 + 15.0 * k, -10.0 - 0.4 * (k % 2), 0, {9.0, 3.0, 5.0}));
        boxes.push_back(test::boxAt(-28.0 + 13.0 * k, 6.0, 0, {0.3, 0.3, 4.0}));
        if (k % 2 == 0) boxes.push_back(test::carAt(-25.0 + 12.0 * k, -5.0, 0));
    }
    return boxes;
}

/// Two smooth walls without an end.
std::vector<OrientedBox> tunnel() {
    return {test::boxAt(0, 6, 0, {2000.0, 1.0, 5.0}), test::boxAt(0, -6, 0, {2000.0, 1.0, 5.0})};
}

/// The same walls with buttresses.
std::vector<OrientedBox> roughTunnel() {
    std::vector<OrientedBox> boxes = tunnel();
    for (int k = 0; k < 12; ++k)
        for (const double side : {-1.0, 1.0}) boxes.push_back(test::boxAt(-40.0 + 9.0 * k, 4.5 * side, 0, {1, 2, 5}));
    return boxes;
}

PointCloud seenFrom(const Place& place, const std::vector<OrientedBox>& boxes, double time) {
    test::World world = test::flatWorld();
    const Eigen::Isometry3d T_vehicle_world = place.pose().inverse();
    for (OrientedBox box : boxes) {
        box.center = T_vehicle_world * box.center;
        box.yaw -= place.yaw;
        world.boxes.push_back(box);
    }
    test::Sensor sensor;
    sensor.columns = 900;
    sensor.noise = 0.01;
    PointCloud cloud = castRays(world, sensor).cloud;
    cloud.timestamp = time;
    return cloud;
}

DetectorParams matching() {
    DetectorParams params;
    params.ego.source = "matching";
    return params;
}

/// The matcher and what it said so far.
class Drive {
  public:
    ScanMatch see(const PointCloud& cloud) {
        ScanMatch m = matcher_.match(cloud);
        matcher_.learn(segmentGround(cloud, params_.ground), {});
        if (m.restarted) poses.clear();
        poses.insert(poses.end(), m.poses.begin(), m.poses.end());
        return m;
    }
    ScanMatch see(const Place& place, const std::vector<OrientedBox>& boxes, int scan) {
        return see(seenFrom(place, boxes, kStart + kTurn * scan));
    }
    /// The way from the first pose to the last.
    Eigen::Isometry3d way() const { return isometry(poses.front()).inverse() * isometry(poses.back()); }
    static Eigen::Isometry3d isometry(const StampedPose& p) {
        Eigen::Isometry3d T(p.orientation);
        T.translation() = p.position;
        return T;
    }

    std::vector<StampedPose> poses;

  private:
    DetectorParams params_ = matching();
    ScanMatcher matcher_{params_.ego, params_.region.own_body};
};

void expectWay(const Eigen::Isometry3d& way, const Place& truth, double metres) {
    EXPECT_NEAR(way.translation().x(), truth.x, metres);
    EXPECT_NEAR(way.translation().y(), truth.y, metres);
    EXPECT_NEAR(way.translation().z(), 0.0, 0.03);
    EXPECT_NEAR(std::atan2(way.linear()(1, 0), way.linear()(0, 0)), truth.yaw, test::radians(0.3));
}

TEST(ScanMatcher, FollowsAVehicleThatDrivesAndTurns) {
    Drive drive;
    constexpr double kSpeed = 10.0, kRate = 0.3;
    for (int k = 0; k < 15; ++k) {
        const ScanMatch m = drive.see(driven(kSpeed, kRate, kTurn * k), road(), k);
        EXPECT_EQ(m.state, k == 0 ? MatchState::First : MatchState::Matched) << k;
        EXPECT_LT(m.residual, 0.04) << k;
        EXPECT_FALSE(m.restarted);
    }
    ASSERT_EQ(drive.poses.size(), 15u) << "the first one comes with the second scan";
    EXPECT_DOUBLE_EQ(drive.poses.front().time, kStart);
    expectWay(drive.way(), driven(kSpeed, kRate, 1.4), 0.06);
}

TEST(ScanMatcher, FindsTheSpeedAtWhichItStartsFromTwoScans) {
    for (const double speed : {-3.0, 0.0, 8.0, 25.0}) {
        Drive drive;
        drive.see(driven(speed, 0.0, 0.0), road(), 0);
        drive.see(driven(speed, 0.0, kTurn), road(), 1);
        ASSERT_EQ(drive.poses.size(), 2u) << speed;
        EXPECT_NEAR(drive.way().translation().x(), speed * kTurn, 0.05) << speed;
    }
}

TEST(ScanMatcher, WhatMovesDoesNotPull) {
    Drive drive;
    for (int k = 0; k < 12; ++k) {
        std::vector<OrientedBox> boxes = road();
        boxes.push_back(test::boxAt(1.0 + 1.4 * k, 3.0, 0, {12.0, 2.5, 3.2}));  // a bus that overtakes
        boxes.push_back(test::carAt(12.0 + 1.0 * k, 0.0, 0));                   // ahead, as fast
        drive.see(driven(10.0, 0.0, kTurn * k), boxes, k);
    }
    ASSERT_EQ(drive.poses.size(), 12u);
    expectWay(drive.way(), driven(10.0, 0.0, 1.1), 0.08);
}

TEST(ScanMatcher, BetweenSmoothWallsItNeverStarts) {
    Drive drive;
    for (int k = 0; k < 5; ++k) {
        std::vector<OrientedBox> boxes = tunnel();
        boxes.push_back(test::carAt(12.0 + 1.5 * k, 0.0, 0));  // as fast: says that nobody moves
        const ScanMatch m = drive.see(driven(15.0, 0.0, kTurn * k), boxes, k);
        EXPECT_EQ(m.state, k == 0 ? MatchState::First : MatchState::Lost) << k;
    }
    EXPECT_TRUE(drive.poses.empty());
}

TEST(ScanMatcher, WhereTheWayAlongIsNotToldItGoesOnForAWhileAndSaysSo) {
    Drive drive;
    int k = 0;
    for (; k < 6; ++k) drive.see(driven(10.0, 0.0, kTurn * k), roughTunnel(), k);
    std::size_t bridged = 0;
    for (; k < 9; ++k) bridged += drive.see(driven(10.0, 0.0, kTurn * k), tunnel(), k).state == MatchState::Bridged;
    EXPECT_EQ(bridged, 3u);
    ASSERT_EQ(drive.poses.size(), 9u);
    expectWay(drive.way(), driven(10.0, 0.0, 0.8), 0.1);
    bool lost = false;
    for (; k < 14; ++k) lost = lost || drive.see(driven(10.0, 0.0, kTurn * k), tunnel(), k).restarted;
    EXPECT_TRUE(lost) << "after ego.max_gap nothing is guessed any more";
    EXPECT_TRUE(drive.poses.empty());
}

TEST(ScanMatcher, AGapInTimeOrTimeThatRunsBackwardsBeginsAnew) {
    for (const double later : {1.0, -1.0}) {
        Drive drive;
        for (int k = 0; k < 3; ++k) drive.see(driven(10.0, 0.0, kTurn * k), road(), k);
        const ScanMatch m = drive.see(seenFrom({}, road(), kStart + 0.2 + later));
        EXPECT_EQ(m.state, MatchState::First);
        EXPECT_TRUE(m.restarted);
        drive.see(seenFrom({1, 0, 0}, road(), kStart + 0.3 + later));
        ASSERT_EQ(drive.poses.size(), 2u);
        EXPECT_NEAR(drive.way().translation().x(), 1.0, 0.05);
    }
}

TEST(ScanMatcher, AScanThatFitsNothingIsLost) {
    Drive drive;
    for (int k = 0; k < 4; ++k) drive.see(driven(10.0, 0.0, kTurn * k), road(), k);
    PointCloud empty;
    empty.timestamp = kStart + 0.4;
    EXPECT_EQ(drive.see(empty).state, MatchState::Lost);
    EXPECT_EQ(drive.see(driven(10.0, 0.0, 0.5), road(), 5).state, MatchState::First);
    EXPECT_EQ(drive.see(driven(10.0, 0.0, 0.6), road(), 6).state, MatchState::Matched);
}

TEST(ScanMatcher, SameScansSamePoses) {
    std::vector<StampedPose> before;
    for (int run = 0; run < 2; ++run) {
        Drive drive;
        for (int k = 0; k < 5; ++k) drive.see(driven(12.0, 0.2, kTurn * k), road(), k);
        for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(before[k].position, drive.poses[k].position);
        before = drive.poses;
    }
}

/// A scan whose columns are fired one after the other over its time, each from where the vehicle then is.
PointCloud sweptFrom(double start, double speed) {
    constexpr int kParts = 20;
    PointCloud swept;
    for (int part = 0; part < kParts; ++part) {
        const double offset = kTurn * part / kParts;
        const PointCloud now = seenFrom(driven(speed, 0.0, start + offset), road(), 0.0);
        if (part == 0) {
            swept = now;
            swept.xyz.clear();
            swept.ring.clear();
            swept.view.column_of.clear();
            std::fill(swept.view.index.begin(), swept.view.index.end(), -1);
        }
        const int columns = now.view.columns / kParts;
        for (int column = part * columns; column < (part + 1) * columns; ++column)
            for (int ring = 0; ring < now.view.rings; ++ring) {
                const std::int32_t i = now.view.at(ring, column);
                if (i < 0) continue;
                swept.view.at(ring, column) = static_cast<std::int32_t>(swept.size());
                swept.view.column_of.push_back(column);
                swept.xyz.push_back(now.xyz[i]);
                swept.ring.push_back(now.ring[i]);
                swept.time_offset.push_back(static_cast<float>(offset));
            }
    }
    swept.timestamp = kStart + start;
    return swept;
}

TEST(ScanMatcher, PosesBelongToTheMiddleOfAScanThatTakesItsTime) {
    Drive drive;
    for (int k = 0; k < 4; ++k) drive.see(sweptFrom(kTurn * k, 20.0));
    ASSERT_EQ(drive.poses.size(), 4u);
    EXPECT_NEAR(drive.poses[1].time, kStart + 0.1 + 0.0475, 1e-6);
    EXPECT_NEAR(drive.way().translation().x(), 6.0, 0.08);
}

TEST(ObstacleDetector, WithPosesFromTheScansTracksHaveVelocities) {
    ObstacleDetector detector(matching());
    SequenceResult r;
    for (int k = 0; k < 20; ++k) {
        std::vector<OrientedBox> boxes = road();
        boxes.push_back(test::carAt(14.0 + 1.5 * k, 2.5, 0));  // 15 m/s
        r = detector.process(seenFrom(driven(10.0, 0.0, kTurn * k), boxes, kStart + kTurn * k));
        ASSERT_TRUE(r.match);
    }
    EXPECT_EQ(r.pose, PoseFound::At);
    bool ahead = false;
    for (const Obstacle& o : r.detection.obstacles) {
        if (!o.track || o.track->age < 1.0 || !o.track->velocity) continue;
        const bool is_it = std::abs(o.box.center.y() - 2.5) < 1.0 && o.box.center.x() > 10.0;
        EXPECT_NEAR(o.track->velocity->norm(), is_it ? 15.0 : 0.0, is_it ? 1.0 : 0.5) << o.box.center.transpose();
        ahead = ahead || is_it;
    }
    EXPECT_TRUE(ahead);
    EXPECT_FALSE(detector.addPose({})) << "the scans tell the poses";
    EXPECT_FALSE(r.restarted);
    EXPECT_TRUE(detector.process(seenFrom({}, road(), kStart + 9.0)).restarted) << "after a gap";
}

}  // namespace
}  // namespace lidar_obstacles
