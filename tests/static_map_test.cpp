// SPDX-License-Identifier: BSD-3-Clause
// Maps of what stands still.
#include "lidar_obstacles/static_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

#include "support/synthetic_scene.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();

OctomapParams mapIn(const std::string& file) {
    OctomapParams params;
    params.map = file;
    return params;
}

/// Two walls and, in the first of two scans only, a car that then drives away.
void buildStreet(const std::string& file) {
    const test::World with{{test::GroundStrip{}}, {test::boxAt(12, 6, 0, {8, 0.4, 2}), test::carAt(8, 0, 0)}};
    const test::World without{{test::GroundStrip{}}, {test::boxAt(12, 6, 0, {8, 0.4, 2})}};
    StaticMapBuilder map(0.2, 30.0);
    map.insert(castRays(with, test::Sensor{}).cloud, kHere);
    for (int k = 0; k < 4; ++k) map.insert(castRays(without, test::Sensor{}).cloud, kHere);
    map.save(file);
}

TEST(StaticMap, WhatStoodThereIsTakenOutAndWhatIsNewStays) {
    const test::TempFolder folder;
    for (const char* name : {"map.bt", "map.ot"}) {
        buildStreet(folder.file(name));
        const StaticMap map(mapIn(folder.file(name)));
        const test::World now{{test::GroundStrip{}}, {test::boxAt(12, 6, 0, {8, 0.4, 2}), test::carAt(10, -3, 0)}};
        const test::Scan scan = castRays(now, test::Sensor{});
        const auto wall = scan.returnsOn(0), car = scan.returnsOn(1);
        EXPECT_LE(map.filter(scan.cloud, wall, kHere).size(), wall.size() / 50) << name;
        // its lowest returns lie in voxels of the ground, which the map holds as well
        EXPECT_GE(map.filter(scan.cloud, car, kHere).size(), car.size() * 98 / 100) << name;
        EXPECT_FALSE(map.voxelsAround(kHere).empty());
    }
}

TEST(StaticMap, WhatLiesWithinTheMarginOfAKnownVoxelIsKnownOnBothSides) {
    const test::TempFolder folder;
    buildStreet(folder.file("map.bt"));
    OctomapParams params = mapIn(folder.file("map.bt"));
    params.margin = 0.0;
    const StaticMap exact(params);
    const auto isKnown = [](const StaticMap& map, double y) {
        PointCloud cloud;
        cloud.xyz.emplace_back(12.1f, static_cast<float>(y), 1.1f);
        return map.filter(cloud, {0}, kHere).empty();
    };
    double face = 5.0;  // of the wall, turned to the sensor
    while (face < 6.5 && !isKnown(exact, face + 0.1)) face += 0.2;
    double back = face + 0.2;
    while (isKnown(exact, back + 0.1)) back += 0.2;
    ASSERT_LT(face, 6.0);
    for (const double margin : {0.15, 0.35}) {
        params.margin = margin;
        const StaticMap map(params);
        EXPECT_TRUE(isKnown(map, face - margin + 0.01)) << margin;
        EXPECT_TRUE(isKnown(map, back + margin - 0.01)) << margin;
        EXPECT_FALSE(isKnown(map, face - margin - 0.01)) << margin;
        EXPECT_FALSE(isKnown(map, back + margin + 0.01)) << margin;
    }
}

TEST(StaticMap, WhatDroveAwayWhileItWasBuiltIsNotInIt) {
    const test::TempFolder folder;
    buildStreet(folder.file("map.bt"));
    const StaticMap map(mapIn(folder.file("map.bt")));
    const test::World again{{test::GroundStrip{}}, {test::carAt(8, 0, 0)}};
    const test::Scan scan = castRays(again, test::Sensor{});
    const auto car = scan.returnsOn(0);
    EXPECT_GE(map.filter(scan.cloud, car, kHere).size(), car.size() * 9 / 10);
}

/// The ground, a wall, and before it a hedge that lets a share of the beams through, others in each scan.
PointCloud hedgeScan(double through, unsigned seed) {
    const std::vector<OrientedBox> wall{test::boxAt(14, 0, 0, {0.4, 30, 8})};
    const std::vector<OrientedBox> both{test::boxAt(14, 0, 0, {0.4, 30, 8}), test::boxAt(9, 0, 0, {0.6, 6, 1.4})};
    test::Sensor sensor;
    sensor.columns = 900;
    sensor.position.z() += 0.013 * (seed % 31);  // as of a vehicle that moves: not the same rays again and again
    const test::Scan with = castRays({{test::GroundStrip{}}, both}, sensor);
    const test::Scan without = castRays({{test::GroundStrip{}}, wall}, sensor);
    EXPECT_EQ(with.cloud.size(), without.cloud.size()) << "each beam has a return";
    PointCloud cloud = with.cloud;
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (static_cast<double>(random()) < through * 4294967296.0) cloud.xyz[i] = without.cloud.xyz[i];
    return cloud;
}

/// Returns of a cloud between two distances ahead and above the ground.
std::vector<std::int32_t> returnsOnHedge(const PointCloud& cloud) {
    std::vector<std::int32_t> hedge;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f& p = cloud.xyz[i];
        if (p.x() > 8.6f && p.x() < 9.4f && std::abs(p.y()) < 3.1f && p.z() > 0.25f)
            hedge.push_back(static_cast<std::int32_t>(i));
    }
    return hedge;
}

TEST(StaticMap, WhatIsHitAgainAndAgainStaysThoughBeamsGoThroughIt) {
    const test::TempFolder folder;
    StaticMapBuilder builder(0.2, 30.0);
    for (unsigned k = 0; k < 30; ++k) builder.insert(hedgeScan(0.93, k), kHere);
    for (const char* name : {"map.ot", "map.bt"}) {
        builder.save(folder.file(name));
        const StaticMap map(mapIn(folder.file(name)));
        const PointCloud again = hedgeScan(0.93, 99);
        const auto hedge = returnsOnHedge(again);
        ASSERT_GT(hedge.size(), 20u);
        EXPECT_LE(map.filter(again, hedge, kHere).size(), hedge.size() / 6) << name;
    }
}

TEST(StaticMap, WhatStoodForAWhileAndLeftIsNotTakenForPorous) {
    const test::TempFolder folder;
    StaticMapBuilder builder(0.2, 30.0);
    for (unsigned k = 0; k < 30; ++k) builder.insert(hedgeScan(k >= 8 && k < 14 ? 0.0 : 1.0, k), kHere);
    builder.save(folder.file("map.bt"));
    const PointCloud again = hedgeScan(0.0, 99);
    const auto there = returnsOnHedge(again);
    const StaticMap map(mapIn(folder.file("map.bt")));
    EXPECT_GE(map.filter(again, there, kHere).size(), there.size() * 9 / 10);
}

TEST(StaticMap, SaysHowMuchOfSomethingLiesBesideWhatItKnows) {
    const test::TempFolder folder;
    buildStreet(folder.file("map.bt"));
    const StaticMap map(mapIn(folder.file("map.bt")));
    // the near face of the wall lies at y = 5.8
    const PointCloud cloud = test::cloudOf({{12, 5.7f, 1}, {12.5f, 5.65f, 1}, {12, 4.5f, 1}, {13, 3, 1}});
    EXPECT_DOUBLE_EQ(map.shareBeside(cloud, {0, 1}, kHere), 1.0);
    EXPECT_DOUBLE_EQ(map.shareBeside(cloud, {0, 1, 2, 3}, kHere), 0.5);
    EXPECT_DOUBLE_EQ(map.shareBeside(cloud, {}, kHere), 0.0);
}

TEST(StaticMap, IsAskedWhereTheVehicleIs) {
    const test::TempFolder folder;
    buildStreet(folder.file("map.bt"));
    const StaticMap map(mapIn(folder.file("map.bt")));
    Eigen::Isometry3d moved = kHere;
    moved.translation() = Eigen::Vector3d(5, 1, 0);
    moved.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()));
    const test::World world{{test::GroundStrip{}}, {test::boxAt(12, 6, 0, {8, 0.4, 2})}};
    const test::Scan scan = castRays(world, test::Sensor{});
    const auto wall = scan.returnsOn(0);
    const test::Scan from_there =
        test::moved(scan, moved.linear().transpose(), moved.linear().transpose() * -moved.translation());
    EXPECT_LE(map.filter(from_there.cloud, wall, moved).size(), wall.size() / 50);
    EXPECT_GE(map.filter(from_there.cloud, wall, kHere).size(), wall.size() / 2);
}

TEST(StaticMap, ReturnsBeyondTheRangeAreKeptOrDroppedAsTheKeySays) {
    const test::TempFolder folder;
    buildStreet(folder.file("map.bt"));
    OctomapParams params = mapIn(folder.file("map.bt"));
    params.range = 20.0;
    const PointCloud cloud = test::cloudOf({{30, 0, 1}, {5, -5, 1}});
    EXPECT_THAT(StaticMap(params).filter(cloud, {0, 1}, kHere), testing::ElementsAre(0, 1));
    params.beyond = BeyondRange::Drop;
    EXPECT_THAT(StaticMap(params).filter(cloud, {0, 1}, kHere), testing::ElementsAre(1));
    EXPECT_TRUE(StaticMap(params).filter(cloud, {}, kHere).empty());
}

TEST(StaticMap, FilesAreThoseOfOctoMap) {
    const test::TempFolder folder;
    buildStreet(folder.file("map.bt"));
    buildStreet(folder.file("map.ot"));
    octomap::OcTree binary(0.1);
    ASSERT_TRUE(binary.readBinary(folder.file("map.bt")));
    EXPECT_DOUBLE_EQ(binary.getResolution(), 0.2);
    EXPECT_EQ(binary.size(), StaticMap(mapIn(folder.file("map.bt"))).size());
    const std::unique_ptr<octomap::AbstractOcTree> full(octomap::AbstractOcTree::read(folder.file("map.ot")));
    ASSERT_TRUE(full);
    EXPECT_EQ(full->getTreeType(), "OcTree");
    ASSERT_TRUE(binary.writeBinary(folder.file("theirs.bt")));
    EXPECT_EQ(StaticMap(mapIn(folder.file("theirs.bt"))).size(), binary.size());
}

TEST(StaticMap, AFileThatIsNoMapIsNamed) {
    const test::TempFolder folder;
    buildStreet(folder.file("map.bt"));
    test::writeFile(folder.file("cut.bt"), test::readFile(folder.file("map.bt")).substr(0, 600));
    test::writeFile(folder.file("other.bt"), "not a map at all");
    test::writeFile(folder.file("empty.ot"), "");
    for (const char* name : {"cut.bt", "other.bt", "empty.ot", "missing.bt"}) {
        try {
            const StaticMap map(mapIn(folder.file(name)));
            ADD_FAILURE() << name << " was read";
        } catch (const std::runtime_error& e) {
            EXPECT_THAT(e.what(), testing::HasSubstr(name));
        }
    }
    EXPECT_THROW(StaticMap(OctomapParams{}), std::invalid_argument) << "mode = static without a map";
    StaticMapBuilder builder(0.2, 10.0);
    EXPECT_THROW(builder.save(folder.file("map.txt")), std::invalid_argument);
    EXPECT_THROW(builder.save(folder.file("no_folder/map.bt")), std::runtime_error);
}

}  // namespace
}  // namespace lidar_obstacles
