// SPDX-License-Identifier: BSD-3-Clause
// Sequences of scans: what the detector remembers, and what it does without poses.
#include "lidar_obstacles/detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include <random>
#include <set>

#include "lidar_obstacles/seam.h"
#include "support/size_model.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

StampedPose poseAt(double time, double x) {
    StampedPose pose;
    pose.time = time;
    pose.position.x() = x;
    return pose;
}

test::World worldOf(std::vector<OrientedBox> boxes) { return {{test::GroundStrip{}}, std::move(boxes)}; }

PointCloud scanOf(const test::World& world, double time) {
    PointCloud cloud = castRays(world, test::Sensor{}).cloud;
    cloud.timestamp = time;
    return cloud;
}

/// A turn of 0.1 s in which a box ahead moves by `way` metres along x; the columns begin straight ahead.
PointCloud movingAhead(double x, double way) {
    const PointCloud start = scanOf(worldOf({test::boxAt(x, 0, 0, {5.0, 1.9, 2.2})}), 0.0);
    const PointCloud end = scanOf(worldOf({test::boxAt(x + way, 0, 0, {5.0, 1.9, 2.2})}), 0.0);
    PointCloud cloud;
    cloud.sensor_origin = start.sensor_origin;
    cloud.view.rings = start.view.rings;
    cloud.view.columns = start.view.columns;
    cloud.view.index.assign(start.view.index.size(), -1);
    for (int column = 0; column < start.view.columns; ++column) {
        const PointCloud& from = 2 * column < start.view.columns ? start : end;
        for (int ring = 0; ring < start.view.rings; ++ring) {
            const std::int32_t i = from.view.at(ring, from.view.wrap(column + from.view.columns / 2));
            if (i < 0) continue;
            cloud.view.at(ring, column) = static_cast<std::int32_t>(cloud.size());
            cloud.view.column_of.push_back(column);
            cloud.xyz.push_back(from.xyz[i]);
            cloud.ring.push_back(from.ring[i]);
            cloud.time_offset.push_back(0.1f * static_cast<float>(column) / static_cast<float>(start.view.columns));
        }
    }
    return cloud;
}

std::size_t boxesAhead(const DetectionResult& r) {
    return static_cast<std::size_t>(std::count_if(r.obstacles.begin(), r.obstacles.end(), [](const Obstacle& o) {
        return o.box.center.x() > 5.0 && std::abs(o.box.center.y()) < 3.0;
    }));
}

TEST(ObstacleDetector, WithTheDefaultsAScanStandsForItself) {
    ObstacleDetector detector(DetectorParams{});
    const PointCloud cloud = scanOf(test::street(), 1.0);
    const SequenceResult r = detector.process(cloud);
    const DetectionResult alone = detect(cloud, DetectorParams{});
    EXPECT_EQ(r.cloud.xyz, cloud.xyz);
    ASSERT_EQ(r.detection.obstacles.size(), alone.obstacles.size());
    for (const Obstacle& o : alone.obstacles)  // what is followed comes first
        EXPECT_TRUE(std::any_of(r.detection.obstacles.begin(), r.detection.obstacles.end(),
                                [&](const Obstacle& other) { return other.box.center == o.box.center; }));
    EXPECT_FALSE(r.filtered);
    EXPECT_FALSE(r.deskewing);
}

TEST(ObstacleDetector, ANewObstacleIsFoundInItsFirstScanBehindTheFilter) {
    DetectorParams params = test::bySize();
    params.octomap.mode = FilterMode::Spurious;
    ObstacleDetector detector(params);
    for (int k = 0; k < 20; ++k) {
        detector.addPose(poseAt(0.1 * k, 0.0));
        EXPECT_TRUE(detector.process(scanOf(worldOf({}), 0.1 * k)).detection.obstacles.empty());
    }
    detector.addPose(poseAt(2.0, 0.0));
    const SequenceResult r = detector.process(scanOf(worldOf({test::carAt(12, 2, 20), test::personAt(10, -3)}), 2.0));
    EXPECT_EQ(r.detection.obstacles.size(), 2u);
    EXPECT_TRUE(r.filtered);
}

TEST(ObstacleDetector, RainIsFilteredAndNoted) {
    DetectorParams params = test::bySize();
    params.octomap.mode = FilterMode::Spurious;
    ObstacleDetector detector(params);
    PointCloud cloud = scanOf(worldOf({test::carAt(12, 2, 20)}), 0.0);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> share(0.05f, 0.6f);
    for (std::size_t i = 0; i < cloud.size(); i += 25)
        cloud.xyz[i] = cloud.sensor_origin + share(random) * (cloud.xyz[i] - cloud.sensor_origin);
    const SequenceResult r = detector.process(cloud);
    EXPECT_EQ(r.detection.obstacles.size(), 1u);
    EXPECT_GT(r.detection.filtered.size(), 100u);
    for (const std::int32_t i : r.detection.filtered)
        EXPECT_FALSE(std::binary_search(r.detection.candidates.begin(), r.detection.candidates.end(), i));
}

TEST(ObstacleDetector, NothingComesOfNothing) {
    DetectorParams params;
    params.octomap.mode = FilterMode::Spurious;
    params.deskew.enabled = true;
    params.grid.scans = 3;
    ObstacleDetector detector(params);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(detector.process(PointCloud{}).detection.obstacles.empty());
}

TEST(ObstacleDetector, AJumpOfThePosesForgetsWhatWasSeen) {
    DetectorParams params;
    params.octomap.mode = FilterMode::Spurious;
    ObstacleDetector detector(params);
    detector.addPose(poseAt(0.0, 0.0));
    detector.addPose(poseAt(0.1, 0.0));
    detector.addPose(poseAt(0.2, 500.0));
    EXPECT_FALSE(detector.process(scanOf(test::street(), 0.0)).restarted);
    EXPECT_FALSE(detector.process(scanOf(test::street(), 0.1)).restarted);
    EXPECT_TRUE(detector.process(scanOf(test::street(), 0.2)).restarted);
}

TEST(ObstacleDetector, WithoutPosesNothingIsTakenToStandStill) {
    DetectorParams params;
    params.octomap.mode = FilterMode::Spurious;
    params.grid.scans = 3;
    ObstacleDetector detector(params);
    for (int k = 0; k < 3; ++k) {
        const SequenceResult r = detector.process(scanOf(test::street(), 0.1 * k));
        EXPECT_TRUE(r.filtered);
        EXPECT_EQ(r.filter_voxels, 0u) << "nothing is remembered";
        EXPECT_EQ(r.earlier_scans, 0u);
    }
    EXPECT_TRUE(detector.filterVoxels().empty());
}

TEST(ObstacleDetector, TimeThatRunsBackwardsForgetsWhatWasSeen) {
    DetectorParams params;
    params.octomap.mode = FilterMode::Spurious;
    ObstacleDetector detector(params);
    for (int k = 0; k < 4; ++k) detector.addPose(poseAt(0.1 * k, 40.0));
    EXPECT_FALSE(detector.process(scanOf(test::street(), 0.0)).restarted);
    EXPECT_FALSE(detector.process(scanOf(test::street(), 0.2)).restarted);
    EXPECT_TRUE(detector.process(scanOf(test::street(), 0.1)).restarted);
}

TEST(ObstacleDetector, AfterARestartTheScansThatItRemembersGiveTheSame) {
    DetectorParams params;
    params.octomap.mode = FilterMode::Spurious;
    params.octomap.history = 4;
    params.octomap.min_hits = 3;
    params.grid.scans = 3;
    params.tracking.enabled = false;  // tracks remember more than a few scans: their numbers would differ
    EXPECT_EQ(scansRemembered(DetectorParams{}), 10u);
    ASSERT_EQ(scansRemembered(params), 5u);
    const auto scan = [](int k) {
        return scanOf(worldOf({test::carAt(14.0 - 0.5 * k, 3, 20), test::personAt(10.0 - 0.5 * k, -3)}), 0.1 * k);
    };
    ObstacleDetector through(params);
    ObstacleDetector again(params);
    for (int k = 0; k < 12; ++k) {
        through.addPose(poseAt(0.1 * k, 0.5 * k));
        const SequenceResult expected = through.process(scan(k));
        again.restart();
        for (int j = std::max(0, k - 6); j <= k; ++j) again.addPose(poseAt(0.1 * j, 0.5 * j));
        for (int j = std::max(0, k - 5); j < k; ++j) again.process(scan(j));
        const SequenceResult found = again.process(scan(k));
        EXPECT_EQ(found.detection.candidates, expected.detection.candidates) << k;
        EXPECT_EQ(found.detection.grid.occupied, expected.detection.grid.occupied) << k;
        EXPECT_EQ(found.earlier_scans, expected.earlier_scans);
    }
}

TEST(ObstacleDetector, EarlierScansFillTheGridButNoCluster) {
    DetectorParams params;
    params.grid.scans = 3;
    ObstacleDetector detector(params);
    const PointCloud empty = scanOf(worldOf({}), 0.2);
    for (int k = 0; k < 4; ++k) detector.addPose(poseAt(0.1 * k, 0.0));
    const SequenceResult first = detector.process(scanOf(worldOf({test::carAt(12, 2, 20)}), 0.0));
    EXPECT_EQ(first.earlier_scans, 0u);
    const SequenceResult second = detector.process(scanOf(worldOf({test::carAt(12, 2, 20)}), 0.1));
    EXPECT_EQ(second.earlier_scans, 1u);
    EXPECT_GE(second.detection.grid.occupied.size(), first.detection.grid.occupied.size());
    const SequenceResult gone = detector.process(empty);
    EXPECT_EQ(gone.earlier_scans, 2u);
    EXPECT_FALSE(gone.detection.grid.occupied.empty());
    EXPECT_TRUE(gone.detection.obstacles.empty()) << "no return of this scan is there";
}

TEST(ObstacleDetector, EarlierScansFillNoCellsOfTheVehicleNorOfWhatIsNotSearched) {
    DetectorParams params;
    params.region.own_body = "box(-1, 4, -1, 1)";
    params.region.excluded = "box(4, 6, 3, 5)";
    const PointCloud cloud = scanOf(worldOf({}), 0.0);
    const auto occupiedWith = [&](const Eigen::Vector3f& p) {
        EarlierScans earlier;
        earlier.returns.assign(200, p);
        return detect(cloud, params, earlier).grid.occupied.size();
    };
    EXPECT_EQ(occupiedWith({10.0f, 0.0f, 1.0f}), 1u);
    EXPECT_EQ(occupiedWith({3.1f, 0.1f, 1.0f}), 0u) << "the own vehicle";
    EXPECT_EQ(occupiedWith({5.1f, 4.1f, 1.0f}), 0u) << "excluded";
}

TEST(Seam, WhatMovedBetweenTheFirstAndTheLastReturnsIsOneObstacle) {
    for (const double way : {2.0, 1.2, -1.5, -2.5}) {
        const PointCloud torn = movingAhead(14.0, way);
        ObstacleDetector detector(DetectorParams{});
        const SequenceResult r = detector.process(torn);
        EXPECT_TRUE(r.mended) << way;
        EXPECT_EQ(boxesAhead(r.detection), 1u) << way;
        float near = 100.0f, left = -10.0f, right = 10.0f;
        for (const std::int32_t i : r.detection.obstacles[0].points) {
            near = std::min(near, r.cloud.xyz[i].x());
            left = std::max(left, r.cloud.xyz[i].y());
            right = std::min(right, r.cloud.xyz[i].y());
        }
        // half way from 11.5 m on; the farther half has the fewer returns
        EXPECT_NEAR(near, 11.5 + 0.5 * way, 0.05 + 0.06 * std::abs(way)) << way;
        EXPECT_NEAR(left - right, 1.9, 0.15) << way;
    }
}

TEST(Seam, WhatDidNotMoveIsLeftAlone) {
    const PointCloud whole = movingAhead(14.0, 0.0);
    EXPECT_EQ(findSeamGap(whole).rings, 0);
}

TEST(Seam, ATurnThatBeginsWithinAPacketHasOneAsWell) {
    // the turns of a capture are cut at an azimuth: the times of the first packet count from its begin
    PointCloud torn = movingAhead(14.0, 2.0);
    const SeamGap whole = findSeamGap(torn);
    for (float& t : torn.time_offset) t += 1e-3f;
    const SeamGap seam = findSeamGap(torn);
    EXPECT_GE(seam.rings, 2);
    EXPECT_EQ(seam.rings, whole.rings);
    EXPECT_EQ(seam.early, whole.early);
    EXPECT_EQ(seam.late, whole.late);
}

TEST(Seam, ACarWhoseEdgeIsAtTheSeamBeforeAWallIsNotMovedToIt) {
    // columns of a cast scan begin straight behind
    const PointCloud upright =
        scanOf(worldOf({test::boxAt(-12, -1.0, 0, {4.5, 1.96, 1.5}), test::boxAt(-12, 0, 0, {0.4, 30, 4})}), 0.0);
    for (PointCloud cloud : {upright, test::upsideDown(upright)}) {
        for (const std::int32_t column : cloud.view.column_of)
            cloud.time_offset.push_back(0.1f * static_cast<float>(column) / static_cast<float>(cloud.view.columns));
        EXPECT_EQ(findSeamGap(cloud).rings, 0) << cloud.sensor_up.z();
    }
}

TEST(Seam, NothingIsFoundWithoutTimesOrRings) {
    PointCloud cloud = movingAhead(14.0, 2.0);
    cloud.time_offset.clear();
    EXPECT_EQ(findSeamGap(cloud).rings, 0);
    EXPECT_EQ(findSeamGap(PointCloud{}).rings, 0);
    cloud.time_offset.assign(cloud.size(), 0.0f);
    EXPECT_EQ(findSeamGap(cloud).rings, 0) << "all at one time";
}

TEST(Seam, ASensorThatLooksAheadOnlyHasNone) {
    // the wall to the right is nearer than the one to the left
    const test::Scan whole = castRays(
        worldOf({test::boxAt(0, -2.1, 0, {60, 0.2, 3}), test::boxAt(0, 2.7, 0, {60, 0.2, 3})}), test::Sensor{});
    PointCloud half = without(whole, [&](std::int32_t i) { return whole.cloud.xyz[i].x() < 0.0f; }).cloud;
    const int quarter = half.view.columns / 4;
    for (const std::int32_t column : half.view.column_of)
        half.time_offset.push_back(0.05f * static_cast<float>(column - quarter) / static_cast<float>(2 * quarter));
    validate(half);
    EXPECT_EQ(findSeamGap(half).rings, 0);
}

/// A car that drives towards the vehicle, which drives as well: a bonnet, a cabin, and room below, as a plain box is
/// taken for a crate.
PointCloud oncoming(int k) {
    const double x = 30.0 - 0.9 * k;
    return scanOf(worldOf({{{x, 4.0, 0.6}, {4.4, 1.8, 0.7}, 0.0},
                           {{x + 0.2, 4.0, 1.2}, {2.4, 1.6, 0.5}, 0.0},
                           test::personAt(12.0 - 0.5 * k, -4)}),
                  0.1 * k);
}

const Obstacle* nearTo(const DetectionResult& r, double x, double y) {
    for (const Obstacle& o : r.obstacles)
        if ((o.box.center.head<2>() - Eigen::Vector2d(x, y)).norm() < 2.0) return &o;
    return nullptr;
}

TEST(ObstacleDetector, TracksKeepTheirNumbersAndTellVelocitiesOverGround) {
    ObstacleDetector detector{DetectorParams{}};
    int id = -1;
    for (int k = 0; k < 15; ++k) {
        detector.addPose(poseAt(0.1 * k, 0.5 * k));
        const SequenceResult r = detector.process(oncoming(k));
        EXPECT_TRUE(r.tracked);
        const Obstacle* car = nearTo(r.detection, 30.0 - 0.9 * k, 4);
        ASSERT_NE(car, nullptr) << k;
        ASSERT_TRUE(car->track) << k;
        if (k == 3) id = car->id;
        if (k < 10) continue;
        EXPECT_EQ(car->id, id) << k;
        ASSERT_TRUE(car->track->velocity);
        EXPECT_NEAR(car->track->velocity->x(), -4.0, 1.0) << k;
        EXPECT_TRUE(car->track->moving);
    }
}

TEST(ObstacleDetector, TracksLongerThanTheirClassMayBeAreUnknownAndKeepTheirNumbers) {
    DetectorParams strict;
    strict.gates.max_length_vehicle = 0.3;
    ObstacleDetector usual{DetectorParams{}}, detector{strict};
    int vehicles = 0;
    for (int k = 0; k < 8; ++k) {
        for (ObstacleDetector* d : {&usual, &detector}) d->addPose(poseAt(0.1 * k, 0.5 * k));
        const SequenceResult expected = usual.process(oncoming(k)), r = detector.process(oncoming(k));
        ASSERT_EQ(r.detection.obstacles.size(), expected.detection.obstacles.size());
        for (std::size_t n = 0; n < r.detection.obstacles.size(); ++n) {
            const Obstacle &o = r.detection.obstacles[n], &same = expected.detection.obstacles[n];
            EXPECT_EQ(o.id, same.id);
            EXPECT_EQ(o.box.center, same.box.center);
            if (!same.track || !same.track->seen) continue;
            const bool vehicle = same.cls == ObstacleClass::Vehicle;
            EXPECT_EQ(o.cls, vehicle ? ObstacleClass::Unknown : same.cls);
            vehicles += vehicle;
        }
    }
    EXPECT_GT(vehicles, 2);
}

TEST(ObstacleDetector, WithoutPosesTracksHaveNoVelocity) {
    ObstacleDetector detector{DetectorParams{}};
    for (int k = 0; k < 10; ++k)
        for (const Obstacle& o : detector.process(oncoming(k)).detection.obstacles)
            EXPECT_FALSE(o.track && o.track->velocity);
}

TEST(ObstacleDetector, AJumpOfThePosesEndsTheTracks) {
    ObstacleDetector detector{DetectorParams{}};
    std::set<int> before;
    for (int k = 0; k < 8; ++k) {
        detector.addPose(poseAt(0.1 * k, k < 5 ? 0.0 : 100.0));
        const SequenceResult r = detector.process(oncoming(k));
        for (const Obstacle& o : r.detection.obstacles) {
            if (!o.track) continue;  // structure is not followed
            if (k < 5) before.insert(o.id);
            if (k == 5) {
                EXPECT_EQ(before.count(o.id), 0u);
                EXPECT_EQ(o.track->age, 0.0);
            }
        }
    }
    EXPECT_FALSE(before.empty());
}

TEST(ObstacleDetector, StructureTakesNoNumbersOfTracks) {
    ObstacleDetector detector{DetectorParams{}};
    int highest = 0;
    std::size_t pieces = 0;
    for (int k = 0; k < 8; ++k) {
        detector.addPose(poseAt(0.1 * k, 0.0));
        std::set<int> ids;
        const SequenceResult r = detector.process(scanOf(test::street(), 0.1 * k));
        for (const Obstacle& o : r.detection.obstacles) {
            EXPECT_TRUE(ids.insert(o.id).second) << "twice in a scan: " << o.id;
            pieces += o.id >= kFirstUntrackedId;
            if (o.track)
                highest = std::max(highest, o.id);
            else
                EXPECT_GE(o.id, kFirstUntrackedId);
        }
    }
    EXPECT_GT(pieces, 0u);
    EXPECT_LT(highest, 100);
}

TEST(ObstacleDetector, TrackingOffLeavesTheBoxesAsTheyAre) {
    DetectorParams params;
    params.tracking.enabled = false;
    ObstacleDetector detector(params);
    for (int k = 0; k < 4; ++k) {
        const SequenceResult r = detector.process(oncoming(k));
        EXPECT_FALSE(r.tracked);
        for (const Obstacle& o : r.detection.obstacles) EXPECT_FALSE(o.track);
    }
}

}  // namespace
}  // namespace lidar_obstacles
