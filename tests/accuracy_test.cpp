// SPDX-License-Identifier: BSD-3-Clause
// Guards on labelled scans: limits a little worse than what was measured, so that a change that costs accuracy shows.
// Tables for people come from the evaluation of obstacle-replay's output; here two figures are enough.
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/pipelines.h"
#include "support/box_geometry.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

using namespace test;

struct Truth {
    OrientedBox box;
    int points = 0;
    double range = 0.0;
};

double number(const std::map<std::string, std::string>& row, const std::string& key) { return std::stod(row.at(key)); }

/// The pose at the instant when the laser saw the object, where the set tells it.
OrientedBox boxOf(const std::map<std::string, std::string>& row) {
    const std::string seen = row.count("x_obs") != 0 ? "_obs" : "";
    OrientedBox box;
    box.center = {number(row, "x" + seen), number(row, "y" + seen), number(row, "z" + seen)};
    box.size = {number(row, "length"), number(row, "width"), number(row, "height")};
    box.yaw = number(row, "yaw" + seen);
    return box;
}

/// The vehicles of each scan: car, van and truck.
std::map<int, std::vector<Truth>> readVehicles(const std::string& path) {
    std::ifstream file(path);
    std::vector<std::string> names;
    std::map<int, std::vector<Truth>> scans;
    for (std::string line; std::getline(file, line);) {
        std::istringstream cells(line);
        std::vector<std::string> values;
        for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
        if (names.empty()) {
            names = values;
            continue;
        }
        std::map<std::string, std::string> row;
        for (std::size_t k = 0; k < std::min(names.size(), values.size()); ++k) row[names[k]] = values[k];
        if (row["type"] != "car" && row["type"] != "van" && row["type"] != "truck") continue;
        const Truth truth{boxOf(row), static_cast<int>(number(row, "num_points")), number(row, "range_nearest")};
        scans[static_cast<int>(number(row, "scan_index"))].push_back(truth);
    }
    return scans;
}

struct Score {
    int asked = 0;
    int found = 0;
    std::vector<double> face_errors;     ///< [m]
    std::vector<double> heading_errors;  ///< [deg]

    double recall() const { return asked > 0 ? static_cast<double>(found) / asked : 0.0; }
};

double quantile(std::vector<double> values, double q) {
    if (values.empty()) return kInfinity;
    const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<std::size_t>(at)];
}

/// Holds the obstacles of a scan against the vehicles that one may ask for: 15 returns, 30 m, within the labelled view.
void hold(const std::vector<Obstacle>& obstacles, const std::vector<Truth>& vehicles, double half_view_deg,
          Score& score) {
    for (const Truth& t : vehicles) {
        const double bearing = degrees(std::atan2(t.box.center.y(), t.box.center.x()));
        if (t.points < 15 || t.range > 30.0 || std::abs(bearing) > half_view_deg) continue;
        ++score.asked;
        const Obstacle* nearest = nullptr;
        double least = 2.5;  // centres further apart are not the same vehicle
        for (const Obstacle& o : obstacles) {
            const double apart = (o.box.center - t.box.center).head<2>().norm();
            if (apart >= least) continue;
            least = apart;
            nearest = &o;
        }
        if (nearest == nullptr) continue;
        ++score.found;
        score.heading_errors.push_back(headingError(nearest->box.yaw, t.box.yaw));
        score.face_errors.push_back(
            std::abs(distanceTo(nearest->box, Eigen::Vector2d::Zero()) - distanceTo(t.box, Eigen::Vector2d::Zero())));
    }
}

/// Runs every k-th scan of a labelled rawlog.
Score run(const std::string& rawlog, const std::string& truth, int every, double half_view_deg) {
    const auto vehicles = readVehicles(truth);
    const auto source = openScanSource(rawlog);
    Score score;
    int scan = -1;
    while (const auto item = source->next()) {
        if (!item->observation || !isLidarScan(*item->observation) || ++scan % every != 0) continue;
        const auto labelled = vehicles.find(scan);
        if (labelled == vehicles.end()) continue;
        const PointCloud cloud = *toPointCloud(*item->observation, SensorParams{});
        hold(detect(cloud, withAlgorithm(Algorithm::Planes16)).obstacles, labelled->second, half_view_deg, score);
    }
    std::cout << score.found << " of " << score.asked << " vehicles, face " << quantile(score.face_errors, 0.5)
              << " m (p95 " << quantile(score.face_errors, 0.95) << "), heading " << quantile(score.heading_errors, 0.5)
              << " deg (p95 " << quantile(score.heading_errors, 0.95) << ")\n";
    return score;
}

TEST(Accuracy, VehiclesOfARealDriveAreFound) {
    LIDAR_OBSTACLES_NEED(rawlog, labelledData("kitti_0001_16.rawlog"));
    LIDAR_OBSTACLES_NEED(truth, labelledData("kitti_0001_16_gt.csv"));
    const Score score = run(rawlog, truth, 1, 40.0);
    ASSERT_GT(score.asked, 100);
    EXPECT_GE(score.recall(), 0.96);
    EXPECT_LE(quantile(score.face_errors, 0.5), 0.08);
    // the 95th percentile is that of seven boxes: its bootstrap interval goes from .16 to 2.4 m
    EXPECT_LE(quantile(score.face_errors, 0.9), 0.25);
    EXPECT_LE(quantile(score.heading_errors, 0.5), 2.0);
}

TEST(Accuracy, ASimulatedCarIsFoundInAllPoses) {
    LIDAR_OBSTACLES_NEED(rawlog, labelledData("sim_yaw_sedan.rawlog"));
    LIDAR_OBSTACLES_NEED(truth, labelledData("sim_yaw_sedan_gt.csv"));
    const Score score = run(rawlog, truth, 5, 180.0);
    ASSERT_GT(score.asked, 100);
    EXPECT_GE(score.recall(), 0.98);
    EXPECT_LE(quantile(score.face_errors, 0.5), 0.06);
    EXPECT_LE(quantile(score.face_errors, 0.95), 0.22);
    EXPECT_LE(quantile(score.heading_errors, 0.5), 1.0);
    EXPECT_LE(quantile(score.heading_errors, 0.95), 4.0);
}

}  // namespace
}  // namespace lidar_obstacles
