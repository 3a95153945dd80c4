// SPDX-License-Identifier: BSD-3-Clause
// Tracks from end to end: obstacle-track on files, obstacle-replay's formats, and a published detector's boxes.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/evaluation/csv_table.h"
#include "support/shell.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

using evaluation::CsvReader;
using test::TempFolder;

constexpr const char* kHeader =
    "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points,probability\n";

/// A car that drives at 5 m/s past a vehicle that drives at 10 m/s, 20 scans.
void writeScene(const TempFolder& folder) {
    std::ostringstream det, ego;
    det << kHeader;
    ego << "scan_index,timestamp,x,y,z,roll,pitch,yaw\n";
    for (int k = 0; k < 20; ++k) {
        const double t = 1000.0 + 0.1 * k;
        det << std::fixed << t << ',' << k << ",0,vehicle," << 20.0 - 0.5 * k << ",3,0.75,4.2,1.8,1.5,0,1,100,0.9\n";
        ego << std::fixed << k << ',' << t << ',' << 1.0 * k << ",0,0,0,0,0\n";
    }
    test::writeFile(folder.file("det.csv"), det.str());
    test::writeFile(folder.file("ego.csv"), ego.str());
}

int track(const TempFolder& folder, const std::string& arguments) {
    return test::shell(std::string(OBSTACLE_TRACK) + " " + arguments + " >" + folder.file("out.txt") + " 2>" +
                       folder.file("err.txt"));
}

TEST(ObstacleTrack, WritesOneNumberAndTheVelocityOverGround) {
    const TempFolder folder;
    writeScene(folder);
    ASSERT_EQ(track(folder, folder.file("det.csv") + " --ego " + folder.file("ego.csv") + " --output " +
                                folder.file("tracks.csv")),
              0)
        << test::readFile(folder.file("err.txt"));
    CsvReader csv(folder.file("tracks.csv"), {"id", "vx", "age", "moving", "seen", "direction_known"});
    int rows = 0;
    while (csv.next()) {
        EXPECT_EQ(csv.integer("id"), 0);
        EXPECT_TRUE(csv.flag("seen"));
        if (++rows <= 2) {
            EXPECT_EQ(csv.text("vx"), "") << "not yet confirmed";
        }
        if (rows > 12) {
            EXPECT_NEAR(csv.number("vx"), 5.0, 0.3);
        }
    }
    EXPECT_EQ(rows, 20);
}

TEST(ObstacleTrack, TheSameFilesGiveTheSameBytes) {
    const TempFolder folder;
    writeScene(folder);
    for (const char* name : {"a.csv", "b.csv"})
        ASSERT_EQ(track(folder, folder.file("det.csv") + " --standing --output " + folder.file(name)), 0);
    EXPECT_EQ(test::readFile(folder.file("a.csv")), test::readFile(folder.file("b.csv")));
}

TEST(ObstacleTrack, WhatAnotherTrackerDidNotSeeIsNoBox) {
    const TempFolder folder;
    std::ostringstream det;
    det << "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points,seen,max_height\n";
    for (int k = 0; k < 30; ++k)
        det << 1000.0 + 0.1 * k << ',' << k << ",0,vehicle,20,3,0.75,4.2,1.8,1.5,0,1,"
            << (k < 20 ? "100,1,inf" : "0,0,") << '\n';
    test::writeFile(folder.file("det.csv"), det.str());
    ASSERT_EQ(track(folder, folder.file("det.csv") + " --standing --output " + folder.file("t.csv")), 0);
    EXPECT_NE(test::readFile(folder.file("out.txt")).find("10 rows left out"), std::string::npos);
    CsvReader csv(folder.file("t.csv"), {"scan_index", "seen", "max_height"});
    int seen = 0;
    while (csv.next()) {
        seen += csv.flag("seen");
        if (csv.flag("seen")) {
            EXPECT_EQ(csv.text("max_height"), "inf") << "nothing is known to have passed above";
        }
        EXPECT_EQ(csv.flag("seen"), csv.integer("scan_index") < 20);
    }
    EXPECT_EQ(seen, 20);
}

TEST(ObstacleTrack, TwoRunsDoNotWriteOneFile) {
    const TempFolder folder;
    writeScene(folder);
    const std::string target = folder.file("t.csv");
    const std::string job = folder.file("det.csv") + " --standing --output " + target;
    const int other = ::open((target + ".part").c_str(), O_RDWR | O_CREAT, 0666);
    ASSERT_EQ(::flock(other, LOCK_EX), 0);
    EXPECT_EQ(track(folder, job), 1);
    EXPECT_NE(test::readFile(folder.file("err.txt")).find("another run is writing it"), std::string::npos);
    ::close(other);
    EXPECT_EQ(track(folder, job), 0);
}

TEST(ObstacleTrack, ABadCellIsNamedWithItsFileAndLine) {
    const TempFolder folder;
    writeScene(folder);
    test::writeFile(folder.file("bad.csv"),
                    std::string(kHeader) + "1000,0,0,vehicle,x,3,0.75,4.2,1.8,1.5,0,1,100,0.9\n");
    EXPECT_NE(track(folder, folder.file("bad.csv") + " --standing --output " + folder.file("t.csv")), 0);
    const std::string error = test::readFile(folder.file("err.txt"));
    EXPECT_NE(error.find("bad.csv:2"), std::string::npos) << error;
    EXPECT_EQ(test::readFile(folder.file("t.csv")), "");
}

TEST(ObstacleTrack, AScanWithoutAPoseIsAnError) {
    const TempFolder folder;
    writeScene(folder);
    test::writeFile(folder.file("ego.csv"), "scan_index,timestamp,x,y,z,roll,pitch,yaw\n0,1000,0,0,0,0,0,0\n");
    EXPECT_NE(track(folder,
                    folder.file("det.csv") + " --ego " + folder.file("ego.csv") + " --output " + folder.file("t.csv")),
              0);
    EXPECT_NE(test::readFile(folder.file("err.txt")).find("det.csv:3"), std::string::npos);
}

TEST(ObstacleTrack, WantsToBeToldHowTheVehicleMoves) {
    const TempFolder folder;
    writeScene(folder);
    EXPECT_EQ(track(folder, folder.file("det.csv") + " --output " + folder.file("t.csv")), 2);
    EXPECT_NE(test::readFile(folder.file("err.txt")).find("--standing"), std::string::npos);
}

TEST(ObstacleReplay, WritesTracksInAllItsFormats) {
    const TempFolder folder;
    ASSERT_EQ(test::shell(std::string(OBSTACLE_REPLAY) + " " + DATASETS + "street_sample.rawlog --output " +
                          folder.file("run") + " --format csv,jsonl,kitti-tracking >" + folder.file("out.txt") + " 2>" +
                          folder.file("err.txt")),
              0)
        << test::readFile(folder.file("err.txt"));
    std::map<int, std::set<int>> ids_of_scan;
    std::size_t rows = 0;
    std::size_t followed = 0;
    CsvReader csv(folder.file("run/obstacles.csv"), {"scan_index", "id", "age", "seen", "vx", "probability"});
    while (csv.next()) {
        EXPECT_TRUE(ids_of_scan[csv.integer("scan_index")].insert(csv.integer("id")).second) << "twice in a scan";
        ++rows;
        followed += static_cast<std::size_t>(!csv.text("age").empty());
    }
    std::istringstream lines(test::readFile(folder.file("run/obstacles.jsonl")));
    std::size_t objects = 0;
    for (std::string line; std::getline(lines, line);) {
        const auto scan = nlohmann::json::parse(line);
        for (const auto& o : scan["obstacles"]) {
            EXPECT_TRUE(o.contains("probability"));
            if (o["id"].get<int>() < kFirstUntrackedId) {
                EXPECT_TRUE(o.contains("age") && o.contains("velocity"));
            }
            ++objects;
        }
    }
    EXPECT_EQ(objects, rows);
    const std::string tracks = test::readFile(folder.file("run/kitti_tracking.txt"));
    EXPECT_EQ(static_cast<std::size_t>(std::count(tracks.begin(), tracks.end(), '\n')), followed);
    std::istringstream first(tracks.substr(0, tracks.find('\n')));
    std::vector<std::string> words;
    for (std::string word; first >> word;) words.push_back(word);
    EXPECT_EQ(words.size(), 18u);
}

/// HOTA and id switches of a class over the six sequences, weighted by the objects in them, told by the judge's script.
void expectOnKitti(const char* group, double hota, int switches) {
    const TempFolder folder;
    double sum = 0.0, objects = 0.0;
    int idsw = 0;
    for (const char* name : {"0001", "0006", "0010", "0014", "0016", "0018"}) {
        LIDAR_OBSTACLES_NEED(det, labelledData("tracking/" + std::string(name) + "_det.csv"));
        LIDAR_OBSTACLES_NEED(script, environmentFile("LIDAR_OBSTACLES_EVAL_TRACKS"));
        const std::string set = det.substr(0, det.size() - 8);
        ASSERT_EQ(track(folder, det + " --ego " + set + "_ego.csv --output " + folder.file("t.csv")), 0);
        ASSERT_EQ(test::shell("/usr/bin/python3 " + script + " --gt " + set + "_gt.csv --ego " + set +
                              "_ego.csv --det " + folder.file("t.csv") + " --max-range 50 --fov 80 --json " +
                              folder.file("r.json") + " >" + folder.file("out.txt")),
                  0);
        const auto r = nlohmann::json::parse(test::readFile(folder.file("r.json")));
        if (!r.contains(group)) continue;
        const double n = r[group]["gt"];
        sum += n * r[group]["hota"].get<double>();
        objects += n;
        idsw += r[group]["idsw"].get<int>();
    }
    EXPECT_GE(sum / objects, hota);
    EXPECT_LE(idsw, switches);
}

TEST(ObstacleTrack, CarsOfAPublishedDetectorBeatTheStandardTracker) { expectOnKitti("vehicle", 0.785, 12); }

TEST(ObstacleTrack, PedestriansOfAPublishedDetectorBeatTheStandardTracker) { expectOnKitti("pedestrian", 0.67, 8); }

}  // namespace
}  // namespace lidar_obstacles
