// SPDX-License-Identifier: BSD-3-Clause
// Classes, tracks and velocities: what obstacle-evaluate says of them, held against an independent evaluation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/agreement.h"
#include "support/shell.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::readFile;
using test::writeFile;
using testing::AllOf;
using testing::HasSubstr;

class EvaluateTracks : public testing::Test {
  protected:
    std::string path(const std::string& name) const { return folder_.file(name); }
    int shell(const std::string& command) const {
        return test::shell(command + " >'" + path("stdout") + "' 2>'" + path("stderr") + "'");
    }
    int run(const std::string& arguments) const {
        return shell("'" OBSTACLE_EVALUATE "' " + arguments + " --bootstrap 0 --output '" + path("results") + "'");
    }
    json metrics() const { return json::parse(readFile(path("results/metrics.json"))); }

    /// A van at 5 m/s to the left of the vehicle, 20 scans; its track changes its number after the tenth.
    std::string vanFiles(const std::string& second_id = "7") const {
        std::string truth = "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points\n";
        std::string found =
            "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points,probability,vx,vy,"
            "moving,direction_known,age,seen\n";
        for (int k = 0; k < 20; ++k) {
            const std::string scan = std::to_string(100.0 + 0.1 * k) + ',' + std::to_string(k);
            const std::string box = std::to_string(8.0 + 0.5 * k) + ",3,1,5,2,2,0,";
            truth += scan + ",1,van," + box + "5,0,100\n";
            found += scan + ',' + (k < 10 ? "1" : second_id) + ",vehicle," + box + "1,100,0.9,5.5,0,1,1,2,1\n";
        }
        writeFile(path("van_gt.csv"), truth);
        writeFile(path("found.csv"), found);
        return "--truth '" + path("van_gt.csv") + "' --detections '" + path("found.csv") + "'";
    }

  private:
    test::TempFolder folder_;
};

TEST_F(EvaluateTracks, FiguresOfTracksStandInAllOutputs) {
    ASSERT_EQ(run(vanFiles()), 0) << readFile(path("stderr"));
    const json vehicle = metrics()["by_class"]["vehicle"];
    EXPECT_EQ(vehicle["f1"], 1.0);
    EXPECT_EQ(vehicle["idsw"], 1);
    EXPECT_NEAR(vehicle["assa"], 0.5, 1e-6) << "two tracks, each half of the object";
    EXPECT_NEAR(vehicle["velocity"]["moving"]["median"], 0.5, 1e-6);
    EXPECT_EQ(vehicle["velocity"]["heading360"]["reversed"], 0.0);
    EXPECT_EQ(metrics()["blind"]["blind_scans"], 0);
    EXPECT_FALSE(metrics()["by_class"].contains("pedestrian")) << "none was asked for";
    EXPECT_THAT(readFile(path("stdout")), AllOf(HasSubstr("HOTA"), HasSubstr("id switches"), HasSubstr("0.50 / 0.50"),
                                                HasSubstr("near objects without any box: 0 of 19")));
    EXPECT_THAT(readFile(path("results/report.html")),
                AllOf(HasSubstr("Classes and tracks"), HasSubstr("<th>HOTA</th>"), HasSubstr("<th>reversed</th>")));
}

TEST_F(EvaluateTracks, IdsThatRepeatWithinAScanGiveNoFiguresOfTracks) {
    const std::string files = vanFiles();
    writeFile(path("found.csv"),
              readFile(path("found.csv")) + "100.000000,0,1,vehicle,-9,9,1,4,2,2,0,1,50,0.9,,,,,0,1\n");
    ASSERT_EQ(run(files + " --no-report"), 0) << readFile(path("stderr"));
    EXPECT_EQ(metrics()["tracks_missing"], "van: id '1' twice in scan 0 at 100.000000 s");
    EXPECT_FALSE(metrics()["by_class"]["vehicle"].contains("hota"));
    EXPECT_EQ(metrics()["by_class"]["vehicle"]["recall"], 1.0);
    EXPECT_THAT(readFile(path("stdout")), HasSubstr("no figures of tracks: van: id '1' twice in scan 0"));
}

TEST_F(EvaluateTracks, ARecordingIsJudgedWithTheTracksOfTheDetector) {
    ASSERT_EQ(run("--prefix '" STREET_SAMPLE "' --no-report"), 0) << readFile(path("stderr"));
    const std::string rows = readFile(path("results/street_sample/obstacles.csv"));
    EXPECT_THAT(rows.substr(0, rows.find('\n')), HasSubstr("vx,vy"));
    EXPECT_GT(metrics()["by_class"]["vehicle"]["hota"], 0.3);
    ASSERT_EQ(run("--prefix '" STREET_SAMPLE "' --no-report --set tracking.enabled=off"), 0);
    EXPECT_EQ(metrics()["by_class"]["vehicle"]["velocity"]["told"], 0.0);
}

// ---------------------------------------------------------------- agreement with the independent evaluation

/// Digits that it rounds a figure to.
int decimalsOf(const std::string& key) {
    if (key == ".blind.share") return 5;
    if (key.find("boxes_per_scan") != std::string::npos) return 2;
    for (const char* word : {"median", "p95", "false_per_scan", "mostly_tracked"})
        if (key.find(word) != std::string::npos) return 3;
    return 4;
}

/// Ours in the order of theirs: what is told of classes and tracks, on the upper level.
json flattened(const json& metrics) {
    json flat = metrics["by_class"];
    for (const char* name : {"scans", "blind", "boxes_per_scan"}) flat[name] = metrics[name];
    return flat;
}

struct Question {
    const char* set;         ///< PREFIX of truth, below the labelled data
    const char* detections;  ///< likewise; "": our detector's on the recording
    const char* options;
    const char* name;  ///< of the test
};

class EvaluateTracksAgreement : public EvaluateTracks, public testing::WithParamInterface<Question> {
  protected:
    void expectBothToAgree() {
        LIDAR_OBSTACLES_NEED(script, environmentFile("LIDAR_OBSTACLES_EVAL_TRACKS"));
        LIDAR_OBSTACLES_NEED(truth, labelledData(std::string(GetParam().set) + "_gt.csv"));
        const std::string prefix = truth.substr(0, truth.size() - std::string("_gt.csv").size());
        const std::string name = prefix.substr(prefix.rfind('/') + 1);
        std::string found = path("results/" + name + "/obstacles.csv");
        std::string given;
        if (*GetParam().detections != '\0') {
            found = test::labelledData(GetParam().detections);
            given = " --detections '" + found + "'";
        }
        const std::string question = std::string(" ") + GetParam().options + ' ';
        ASSERT_EQ(run("--prefix '" + prefix + "'" + given + question + "--no-report"), 0) << readFile(path("stderr"));
        ASSERT_EQ(shell("/usr/bin/python3 '" + script + "' --prefix '" + prefix + "' --det '" + found + "'" + question +
                        "--json '" + path("theirs.json") + "'"),
                  0)
            << readFile(path("stderr"));
        json theirs = json::parse(readFile(path("theirs.json")));
        theirs.erase("columns");
        if (!theirs.contains("vehicle")) GTEST_FAIL() << "nothing was compared";
        test::expectAgreement(theirs, flattened(metrics()), "", decimalsOf);
    }
};

TEST_P(EvaluateTracksAgreement, WithAnIndependentEvaluation) { expectBothToAgree(); }

INSTANTIATE_TEST_SUITE_P(
    Sets, EvaluateTracksAgreement,
    testing::Values(
        Question{"sim_street", "", "", "sim_street"},
        Question{"sim_street", "", "--gt-pose ref --max-range 50 --near 25", "sim_street_far"},
        Question{"sim_street", "", "--roi=-10,40,-8,8 --min-points 5", "sim_street_part"},
        Question{"kitti_0001_16", "", "--fov 80", "kitti_0001"},
        Question{"kitti_0048_16", "", "--fov 80", "kitti_0048"},
        Question{"sim_yaw_sedan", "", "--gt-pose mid", "sim_yaw_sedan"},
        Question{"tracking/0001", "tracking/0001_det.csv", "--max-range 50 --min-points 1", "tracking_0001"},
        Question{"tracking/0016", "tracking/0016_det.csv", "--max-range 50 --min-points 1", "tracking_0016"}),
    [](const auto& question) { return std::string(question.param.name); });

}  // namespace
}  // namespace lidar_obstacles
