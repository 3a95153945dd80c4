// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/small_worlds.h"
#include "support/test_data.h"

namespace lidar_obstacles::simulation {
namespace {

using test::csvNumber;
using test::csvValue;
using test::truthOf;
using test::worldOf;

bool isInside(const Eigen::Vector3f& point, const std::string& csv, std::size_t row, double grown) {
    const Eigen::Vector3d center(csvNumber(csv, row, "x_obs"), csvNumber(csv, row, "y_obs"),
                                 csvNumber(csv, row, "z_obs"));
    const Eigen::Vector3d half(csvNumber(csv, row, "length"), csvNumber(csv, row, "width"),
                               csvNumber(csv, row, "height"));
    const Eigen::AngleAxisd back(-csvNumber(csv, row, "yaw_obs"), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d local = back * (point.cast<double>() - center);
    return ((local.cwiseAbs() - 0.5 * half).array() <= grown).all();
}

/// For every object with at least `least` returns in turn `index`: returns in its box over what the truth counts.
std::vector<double> shareInBoxes(const World& world, std::size_t index, int least) {
    const LidarScan scan = test::scanOf(world, index);
    const std::string csv = truthOf(world, index);
    std::vector<double> shares;
    const auto rows = static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) - 1;
    for (std::size_t row = 0; row < rows; ++row) {
        const double counted = csvNumber(csv, row, "num_points");
        if (counted < least) continue;
        const auto object = static_cast<std::int32_t>(csvNumber(csv, row, "object_id")) - 1;
        int inside = 0;
        for (const LidarReturn& r : scan.returns)
            if (r.object == object && isInside(r.point, csv, row, 0.1)) ++inside;
        shares.push_back(inside / counted);
    }
    return shares;
}

TEST(Truth, ReturnsOfAnObjectLieInItsBox) {
    for (const char* name : {"street", "delivery"}) {
        const World world = buildWorld(loadScenario(std::string(SCENARIOS) + name + ".yaml"));
        std::vector<double> shares;
        for (std::size_t index = 20; index < 620; index += 120)
            for (double share : shareInBoxes(world, index, 15)) shares.push_back(share);
        ASSERT_GT(shares.size(), 30U) << name;
        double sum = 0.0;
        for (double share : shares) sum += share;
        const double mean = sum / static_cast<double>(shares.size());
        RecordProperty(name, std::to_string(mean));
        EXPECT_GT(mean, 0.98) << name;
    }
}

TEST(Truth, CountsAreExact) {
    const World world = worldOf({"objects: [{model: sedan, s: 112, d: 5}, {model: van, s: 80, d: -3}]\n"});
    const LidarScan scan = test::scanOf(world);
    const std::string csv = truthOf(world);
    for (std::int32_t object : {0, 1}) {
        double all = 0.0, first = 0.0, time = 0.0;
        for (const LidarReturn& r : scan.returns) {
            if (r.object != object) continue;
            ++all;
            first += r.firing % 2 == 0 ? 1.0 : 0.0;
            time += r.time;
        }
        const auto row = static_cast<std::size_t>(object);
        EXPECT_GT(all, 100.0);
        EXPECT_EQ(csvNumber(csv, row, "num_points"), all);
        EXPECT_EQ(csvNumber(csv, row, "num_points_mrpt"), first);
        EXPECT_NEAR(csvNumber(csv, row, "t_obs") - kEpoch, scan.turn.start() + time / all, 1e-6);
    }
}

TEST(Truth, PosesAreRelativeToTheVehicleOfTheirTime) {
    test::SmallWorld small;
    small.ego = "[{t: 0, s: 100}, {t: 10, s: 200}]";                                                   // 10 m/s
    small.lists = "objects: [{model: sedan, path: [{t: 0, s: 120, d: 4}, {t: 10, s: 160, d: 4}]}]\n";  // 4 m/s
    const World world = worldOf(small);
    const std::string csv = truthOf(world, 20);
    const double t = csvNumber(csv, 0, "timestamp") - kEpoch;
    EXPECT_NEAR(t, 2.0, 0.002);
    EXPECT_NEAR(csvNumber(csv, 0, "x"), 20.0 - 6.0 * t, 1e-3);
    EXPECT_NEAR(csvNumber(csv, 0, "y"), 4.0, 1e-3);
    EXPECT_NEAR(csvNumber(csv, 0, "z"), 0.73, 1e-3);
    EXPECT_NEAR(csvNumber(csv, 0, "x_mid"), 20.0 - 6.0 * (csvNumber(csv, 0, "t_mid") - kEpoch), 1e-3);
    EXPECT_NEAR(csvNumber(csv, 0, "x_obs"), 20.0 - 6.0 * (csvNumber(csv, 0, "t_obs") - kEpoch), 1e-3);
    EXPECT_NEAR(csvNumber(csv, 0, "vx"), 4.0, 1e-3);
    EXPECT_NEAR(csvNumber(csv, 0, "vrel_x"), -6.0, 1e-3);
    EXPECT_NEAR(csvNumber(csv, 0, "x_w"), 120.0 + 4.0 * t, 1e-3);
}

TEST(Truth, FacesAndRangeAreThoseOfTheBox) {
    const World world = worldOf({"objects: [{model: truck, s: 120, d: 0}, {model: truck, s: 100, d: 8}]\n"});
    const std::string csv = truthOf(world);
    EXPECT_EQ(csvValue(csv, 0, "visible_faces"), "B");  // straight ahead, seen from behind
    EXPECT_NEAR(csvNumber(csv, 0, "range_nearest"), 16.0, 1e-3);
    EXPECT_EQ(csvValue(csv, 1, "visible_faces"), "R");  // to the left: its right side
    EXPECT_NEAR(csvNumber(csv, 1, "range_nearest"), 6.75, 1e-3);
}

TEST(Truth, HiddenObjectsAreOccluded) {
    const World world = worldOf(
        {"objects: [{model: sedan, s: 125, d: 0}, {model: sedan, s: 75, d: 0, yaw: 90}, {model: sedan, s: 100, d: "
         "15}]\n"
         "clutter: [{type: wall, from: 110, to: 111, d: 0, width: 30, height: 4}, {type: building, s: 85, d: 5, "
         "length: 1, width: 10, height: 4}]\n"});
    const std::string csv = truthOf(world);
    EXPECT_EQ(csvNumber(csv, 0, "occluded"), 1.0);
    EXPECT_EQ(csvNumber(csv, 0, "num_points"), 0.0);
    EXPECT_EQ(csvValue(csv, 0, "visible_faces"), "-");
    EXPECT_NEAR(csvNumber(csv, 1, "occluded"), 0.5, 0.1);  // the building hides what stands left of the middle
    EXPECT_EQ(csvNumber(csv, 2, "occluded"), 0.0);
}

TEST(Truth, ColumnsAreThoseOfTheOtherSimulatedSets) {
    for (const auto& [file, header] :
         {std::pair{"sim_street_gt.csv", truthHeader()},
          {"sim_street_ego.csv", egoHeader()},
          {"sim_street_static.csv", std::string("type,x,y,z,length,width,height,yaw\n")}}) {
        LIDAR_OBSTACLES_NEED(path, labelledData(file));
        std::ifstream in(path);
        std::string line;
        std::getline(in, line);
        EXPECT_EQ(line + "\n", header);
    }
}

}  // namespace
}  // namespace lidar_obstacles::simulation
