// Maps of what stands still.
#include "lidar_obstacles/static_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <numeric>
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

TEST(StaticMap, WhatDroveAwayWhileItWasBuiltIsNotInIt) {
    const test::TempFolder folder;
    buildStreet(folder.file("map.bt"));
    const StaticMap map(mapIn(folder.file("map.bt")));
    const test::World again{{test::GroundStrip{}}, {test::carAt(8, 0, 0)}};
    const test::Scan scan = castRays(again, test::Sensor{});
    const auto car = scan.returnsOn(0);
    EXPECT_GE(map.filter(scan.cloud, car, kHere).size(), car.size() * 9 / 10);
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
