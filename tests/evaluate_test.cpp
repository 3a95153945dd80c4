// SPDX-License-Identifier: BSD-3-Clause
// obstacle-evaluate from end to end: each test runs the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "support/agreement.h"
#include "support/labelled_rows.h"
#include "support/shell.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::readFile;
using test::writeFile;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Outcome {
    int code = -1;
    std::string out;
    std::string err;
};

class Evaluate : public testing::Test {
  protected:
    Outcome shell(const std::string& command) const {
        const int code = test::shell(command + " >'" + path("stdout") + "' 2>'" + path("stderr") + "'");
        return {code, readFile(path("stdout")), readFile(path("stderr"))};
    }
    Outcome run(const std::string& arguments, const std::string& output = "results") const {
        return shell("'" OBSTACLE_EVALUATE "' " + arguments + " --output '" + path(output) + "'");
    }
    std::string path(const std::string& name) const { return folder_.file(name); }
    json metrics(const std::string& output = "results") const {
        return json::parse(readFile(path(output) + "/metrics.json"));
    }

    /// Truth of a van in ten scans, and detections 0.2 m farther, one scan missed; as --truth and --detections.
    std::string vanFiles() const {
        std::string truth = "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points\n";
        std::string found = "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points\n";
        for (int k = 0; k < 10; ++k) {
            const std::string scan = std::to_string(100 + k) + ',' + std::to_string(k);
            truth += scan + ",1,van,10,0,1,5,2,2,0,0,0,100\n";
            if (k != 4) found += scan + ",1,vehicle,10.2,0,1,5,2,2,0,1,100\n";
        }
        writeFile(path("van_gt.csv"), truth);
        writeFile(path("found.csv"), found);
        return "--truth '" + path("van_gt.csv") + "' --detections '" + path("found.csv") + "'";
    }

    /// The sample scan as a set, with boxes that stand somewhere in it: PREFIX.rawlog and PREFIX_gt.csv.
    std::string sampleSet(const std::string& name, double x) const {
        fs::copy_file("/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog", path(name + ".rawlog"));
        std::string truth = "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points\n";
        for (int k = 0; k < 8; ++k) {
            truth += "1519637061.085268,0," + std::to_string(k) + ",car," + std::to_string(x + 2 * k) + ',' +
                     std::to_string(3 * k - 12) + ",-1.5,4,2,1.5,0.1,0,0,50\n";
        }
        writeFile(path(name + "_gt.csv"), truth);
        return " --prefix '" + path(name) + "'";
    }

  private:
    test::TempFolder folder_;
};

TEST_F(Evaluate, TheSensorsPlaceIsSaidAsInReplay) {
    const std::string set = sampleSet("sample", 5.0) + " --no-report --bootstrap 0";
    ASSERT_EQ(run(set + " --sensor-pose 0,0,50,0,0,0").code, 0);
    std::istringstream rows(readFile(path("results/sample/obstacles.csv")));
    std::string row;
    std::getline(rows, row);
    int count = 0;
    for (; std::getline(rows, row); ++count) {
        std::istringstream cells(row);
        std::string z;
        for (int k = 0; k < 7; ++k) std::getline(cells, z, ',');
        EXPECT_GT(std::stod(z), 40.0) << "all of it lies as high as the sensor is said to";
    }
    EXPECT_GT(count, 5);
    const Outcome wrong = run(set + " --sensor-pose 0,0,1.8");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("must be X,Y,Z,YAW,PITCH,ROLL"));
    const Outcome unknown = run(set + " --sensor-label front,rear");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(unknown.err, HasSubstr("no lidar 'front'; there are: "));
}

TEST_F(Evaluate, ExistingDetectionsAreJudged) {
    const Outcome r = run(vanFiles() + " --no-report");
    ASSERT_EQ(r.code, 0) << r.err;
    const json m = metrics();
    EXPECT_EQ(m["scans"], 10);
    EXPECT_EQ(m["vehicle"]["gt"], 10);
    EXPECT_EQ(m["vehicle"]["hit"], 9);
    EXPECT_NEAR(m["vehicle"]["face_m"]["mean"], 0.2, 1e-6);
    EXPECT_NEAR(m["vehicle"]["iou"]["mean"], 4.8 / 5.2, 1e-6);
    EXPECT_EQ(m["vehicle"]["swap_rate"], 0.0);
    EXPECT_EQ(m["class_of_matched"]["van"]["vehicle"], 9);
    EXPECT_EQ(m["vehicle"]["bins"]["5-10"]["gt"], 10);
    EXPECT_THAT(r.out, HasSubstr("vehicle"));
    EXPECT_THAT(readFile(path("results/objects.csv")), HasSubstr("van,1,van,10,9,0.9000,7.500,7.500,0.2000,0.2000"));
    EXPECT_THAT(readFile(path("results/matches.csv")), HasSubstr("\nvan,104.000000,4,1,van,1,100,"));
    EXPECT_FALSE(fs::exists(path("results/report.html")));
}

TEST_F(Evaluate, TheReportIsOneFileWithTablesPlotsAndPictures) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    const Outcome r = run(sampleSet("sample", 5.0) + " --worst 1");
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_TRUE(fs::exists(path("results/sample/obstacles.csv")));
    const std::string page = readFile(path("results/report.html"));
    EXPECT_THAT(page, AllOf(HasSubstr("<table>"), HasSubstr("<svg"), HasSubstr("data:image/jpeg;base64,"),
                            HasSubstr("not found"), HasSubstr("</html>")));
    EXPECT_THAT(page, AllOf(Not(HasSubstr("src=\"http")), Not(HasSubstr("<script")), Not(HasSubstr("<?xml"))));
}

TEST_F(Evaluate, DetectionsThatAreGivenAreDrawnIntoTheirScans) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    writeFile(path("found.csv"),
              "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points\n"
              "1519637061.085268,0,0,vehicle,5,-12,-1.5,4,2,1.5,1.2,1,50\n");
    const Outcome r = run(sampleSet("sample", 5.0) + " --detections '" + path("found.csv") + "'");
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_FALSE(fs::exists(path("results/sample")));
    EXPECT_EQ(metrics()["vehicle"]["hit"], 1);
    EXPECT_THAT(readFile(path("results/report.html")), HasSubstr("data:image/jpeg;base64,"));
}

TEST_F(Evaluate, NumbersAreTheSameWhateverTheJobs) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    const std::string sets = sampleSet("a", 4.0) + sampleSet("b", 7.0) + sampleSet("c", 10.0) + " --no-report";
    ASSERT_EQ(run(sets + " --jobs 1", "one").code, 0);
    ASSERT_EQ(run(sets + " --jobs 3", "three").code, 0);
    EXPECT_EQ(metrics("one")["vehicle"]["gt"], 24);
    EXPECT_GT(metrics("one")["vehicle"]["ci95"].size(), 0U);
    for (const char* file : {"metrics.json", "objects.csv", "matches.csv", "b/obstacles.csv"})
        EXPECT_EQ(readFile(path("one/") + file), readFile(path("three/") + file)) << file;
}

TEST_F(Evaluate, MonzaDrawsTheTargetOverTimeForBothVariants) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    const Outcome r = run("monza" + sampleSet("lap", 5.0) + " --target id:3 --jobs 1");
    ASSERT_EQ(r.code, 0) << r.err;
    for (const char* name : {"fig_16_plane", "fig_8_plane"}) {
        EXPECT_THAT(readFile(path("results/") + name + ".png").substr(0, 4), "\x89PNG");
        EXPECT_THAT(readFile(path("results/") + name + ".svg"), HasSubstr("<svg"));
    }
    const json monza = json::parse(readFile(path("results/monza.json")));
    EXPECT_EQ(monza["variants"]["16_plane"]["gt"], 1);
    EXPECT_EQ(monza["paper"]["paper, 8 planes"]["mean_distance_error_m"], 0.8);
    EXPECT_THAT(r.out, AllOf(HasSubstr("paper, 16 planes"), HasSubstr("velocity")));
    EXPECT_THAT(readFile(path("results/fig_16_plane.gp")), HasSubstr("velocity over ground [m/s]")) << "no poses";
    EXPECT_THAT(readFile(path("results/monza.html")), HasSubstr("8_plane/report.html"));
}

TEST_F(Evaluate, MonzaDrawsVelocitiesRelativeToTheVehicleWhereItsPosesAreKnown) {
    const Outcome r = run("monza --prefix '" STREET_SAMPLE "' --target car --variant one:sensor.planes=16 --worst 0");
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(readFile(path("results/fig_one.gp")), HasSubstr("velocity over ground")) << "its scans are 2 s apart";
    writeFile(path("lap_ego.csv"),
              "scan_index,timestamp,x,y,z,roll,pitch,yaw\n0,1519637061.085268,0,0,0,0,0,0\n"
              "1,1519637061.185268,1,0,0,0,0,0\n");
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    const Outcome known =
        run("monza" + sampleSet("lap", 5.0) + " --target id:3 --variant one:sensor.planes=16 --worst 0");
    ASSERT_EQ(known.code, 0) << known.err;
    const std::string script = readFile(path("results/fig_one.gp"));
    EXPECT_THAT(script, HasSubstr("relative velocity [m/s]"));
    EXPECT_THAT(script, HasSubstr(" -10.000 ")) << "what stands comes nearer at the vehicle's 10 m/s";
}

TEST_F(Evaluate, WhatIsWrongWithFilesAndFlagsIsSaid) {
    const std::string files = vanFiles();
    writeFile(path("bad.csv"), "timestamp,scan_index\n");
    const Outcome bad = run("--truth '" + path("van_gt.csv") + "' --detections '" + path("bad.csv") + "' --no-report");
    EXPECT_EQ(bad.code, 1);
    EXPECT_THAT(bad.err, HasSubstr("bad.csv:1: no column 'id'"));
    EXPECT_EQ(run("").code, 2);
    EXPECT_EQ(run("--truth '" + path("van_gt.csv") + "'").code, 2);
    EXPECT_EQ(run(files + " --roi 1,2,3").code, 2);
    EXPECT_EQ(run(files + " --gt-pose now").code, 2);
    EXPECT_EQ(run(files + " --set grid.resolution=abc --no-report").code, 2);
    const Outcome no_target = run(files + " --target tram --no-report");
    EXPECT_EQ(no_target.code, 1);
    EXPECT_THAT(no_target.err, HasSubstr("van: no object fits the target 'tram'"));
    const Outcome damaged =
        run("--truth '" + path("van_gt.csv") + "' --rawlog '" + path("found.csv") + "' --no-report");
    EXPECT_EQ(damaged.code, 1);
    EXPECT_THAT(damaged.err, HasSubstr("found.csv"));
    EXPECT_FALSE(fs::exists(path("results/van/obstacles.csv")));
}

TEST_F(Evaluate, TypesAreTheSameInAnyCase) {
    const std::string files = vanFiles() + " --no-report";
    ASSERT_EQ(run(files + " --ignore Van").code, 0);
    EXPECT_EQ(metrics()["vehicle"]["gt"], 0);
    EXPECT_EQ(run(files + " --target Van").code, 0);
}

TEST_F(Evaluate, ATargetThatIsNeverAskedForLeavesTheReport) {
    vanFiles();
    writeFile(path("few's_gt.csv"),
              "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points\n"
              "100,0,1,van,10,0,1,5,2,2,0,nan,nan,100\n101,1,1,van,10,0,1,5,2,2,0,nan,nan,100\n"
              "100,0,2,car,20,0,1,4,2,2,0,nan,nan,3\n");
    const std::string files = "--truth \"" + path("few's_gt.csv") + "\" --detections '" + path("found.csv") + "'";
    for (const char* target : {"id:1", "id:2"}) {  // without velocities, and with 3 returns
        fs::remove_all(path("results"));
        const Outcome r = run(files + " --target " + target);
        EXPECT_EQ(r.code, 0) << target << r.err;
        EXPECT_TRUE(fs::exists(path("results/report.html"))) << target;
    }
}

TEST_F(Evaluate, SetsOfOneNameAreToldApart) {
    const std::string files = vanFiles();
    std::string sets;
    for (const char* folder : {"a", "b"}) {
        fs::create_directory(path(folder));
        fs::copy_file(path("van_gt.csv"), path(std::string(folder) + "/van_gt.csv"));
        sets += " --truth '" + path(std::string(folder) + "/van_gt.csv") + "' --detections '" + path("found.csv") + "'";
    }
    fs::copy_file(path("van_gt.csv"), path("van_2_gt.csv"));
    sets += " --truth '" + path("van_2_gt.csv") + "' --detections '" + path("found.csv") + "' --no-report";
    ASSERT_EQ(run(sets).code, 0);
    const std::string rows = readFile(path("results/objects.csv"));
    EXPECT_THAT(rows, AllOf(HasSubstr("\nvan,1,"), HasSubstr("\nvan_2,1,"), HasSubstr("\nvan_2_2,1,")));
}

TEST_F(Evaluate, ARawlogThatIsNamedMustBeThere) {
    const Outcome r = run(vanFiles() + " --rawlog '" + path("no.rawlog") + "'");
    EXPECT_NE(r.code, 0);
    EXPECT_THAT(r.err, HasSubstr("no.rawlog"));
}

TEST_F(Evaluate, WhatCannotBePrintedIsAnError) {
    const std::string command = "'" OBSTACLE_EVALUATE "' " + vanFiles() + " --no-report --output '" + path("results");
    EXPECT_EQ(test::shell(command + "' >/dev/full 2>'" + path("stderr") + "'"), 1);
    EXPECT_THAT(readFile(path("stderr")), HasSubstr("cannot write to the standard output"));
}

TEST_F(Evaluate, AUsersPicturesStayWhereNoRunWroteBefore) {
    fs::create_directory(path("results"));
    writeFile(path("results/fig_overview.png"), "a user's");
    ASSERT_EQ(run(vanFiles() + " --no-report").code, 0);
    EXPECT_EQ(readFile(path("results/fig_overview.png")), "a user's");
}

TEST_F(Evaluate, WithoutGnuplotThereIsAllButThePlots) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    const Outcome r = shell("PATH=/nonexistent '" OBSTACLE_EVALUATE "' " + sampleSet("sample", 5.0) +
                            " --worst 1 --target id:3 --output '" + path("results") + "'");
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, AllOf(HasSubstr("No plots"), HasSubstr("gnuplot-nox")));
    EXPECT_EQ(metrics()["vehicle"]["gt"], 8);
    EXPECT_THAT(readFile(path("results/report.html")),
                AllOf(HasSubstr("No plots"), HasSubstr("<table>"), HasSubstr("data:image/jpeg;base64,")));
    const Outcome monza = shell("PATH=/nonexistent '" OBSTACLE_EVALUATE "' monza --prefix '" + path("sample") +
                                "' --target id:3 --worst 0 --output '" + path("monza") + "'");
    EXPECT_EQ(monza.code, 0) << monza.err;
    EXPECT_TRUE(fs::exists(path("monza/monza.html")));
}

TEST_F(Evaluate, ASecondEvaluationLeavesNothingOfTheFirst) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    ASSERT_EQ(run(sampleSet("first", 5.0) + " --worst 1").code, 0);
    writeFile(path("results/notes.txt"), "a user's");
    const std::string again = " --detections '" + path("results/first/obstacles.csv") + "' --no-report";
    ASSERT_EQ(run("--truth '" + path("first_gt.csv") + "'" + again).code, 0) << "it must not take its input away";
    ASSERT_EQ(run(sampleSet("second", 5.0)).code, 0);
    EXPECT_TRUE(fs::exists(path("results/report.html")));
    ASSERT_EQ(run(vanFiles() + " --no-report").code, 0);
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(path("results")))
        files.insert(fs::relative(entry.path(), path("results")));
    EXPECT_EQ(files, (std::set<std::string>{"first", "first/obstacles.csv", "metrics.json", "objects.csv",
                                            "matches.csv", "notes.txt", "written.txt"}));
}

TEST_F(Evaluate, StaticBoxesWantThePosesOfTheVehicle) {
    writeFile(path("static.csv"), "object_id,type,x,y,z,length,width,height,yaw\n");
    const Outcome r = run(vanFiles() + " --static '" + path("static.csv") + "' --no-report");
    EXPECT_EQ(r.code, 2);
    EXPECT_THAT(r.err, HasSubstr("--static " + path("static.csv") + " needs --ego"));
}

TEST_F(Evaluate, HelpAndErrorsAreReadable) {
    for (const char* arguments : {"--help", "monza --help", "--gt-pose now"}) {
        const Outcome r = shell(std::string("'" OBSTACLE_EVALUATE "' ") + arguments);
        const std::string text = r.out + r.err;
        EXPECT_THAT(text, HasSubstr("{ego,mid,obs,ref}"));
        for (const char c : text) ASSERT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << arguments;
    }
}

TEST_F(Evaluate, HelpSaysWhatThereIs) {
    const Outcome r = run("--help");
    EXPECT_EQ(r.code, 0);
    EXPECT_THAT(r.out, AllOf(HasSubstr("--gt-pose"), HasSubstr("monza"), HasSubstr("metrics.json")));
}

// ---------------------------------------------------------------- agreement with the independent evaluation

/// Digits that it rounds a figure to.
int decimalsOf(const std::string& key) {
    for (const char* rate : {"recall", "fp_per_scan", "unmatched", "on_nothing", "valid", "over20", "direction_ok"}) {
        if (key.find(rate) != std::string::npos) return 4;
    }
    return key.find("_deg") != std::string::npos ? 2 : 3;
}

struct Question {
    const char* set;
    const char* options;
};

class EvaluateAgreement : public Evaluate, public testing::WithParamInterface<Question> {};

TEST_P(EvaluateAgreement, WithAnIndependentEvaluation) {
    LIDAR_OBSTACLES_NEED(script, environmentFile("LIDAR_OBSTACLES_EVAL_BOXES"));
    LIDAR_OBSTACLES_NEED(truth, labelledData(std::string(GetParam().set) + "_gt.csv"));
    const std::string prefix = truth.substr(0, truth.size() - std::string("_gt.csv").size());
    const std::string question = std::string(" ") + GetParam().options + ' ';
    const Outcome ours = run("--prefix '" + prefix + "'" + question + "--no-report --bootstrap 0");
    ASSERT_EQ(ours.code, 0) << ours.err;
    const Outcome theirs =
        shell("/usr/bin/python3 '" + script + "' --prefix '" + prefix + "' --det '" + path("results/") +
              GetParam().set + "/obstacles.csv'" + question + "--json '" + path("theirs.json") + "'");
    ASSERT_EQ(theirs.code, 0) << theirs.err;
    const json expected = json::parse(readFile(path("theirs.json")));
    test::expectAgreement(expected, metrics(), "", decimalsOf);
    for (const char* group : {"vehicle", "pedestrian", "cyclist"})
        EXPECT_EQ(expected[group]["bins"].size(), metrics()[group]["bins"].size()) << group;
}

INSTANTIATE_TEST_SUITE_P(
    Sets, EvaluateAgreement,
    testing::Values(Question{"kitti_0001_16", "--fov 80"}, Question{"kitti_0048_16", "--fov 80 --target van"},
                    Question{"kitti_0048_64", "--fov 80 --min-points 50 --points-col num_points_label"},
                    Question{"kitti_object_16", "--fov 80 --max-range 70 --min-points 5"}, Question{"sim_street", ""},
                    Question{"sim_street", "--structure"},
                    Question{"sim_street", "--gt-pose ego --roi=-10,40,-8,8 --target car"},
                    Question{"sim_street", "--gt-pose ref --class-aware --skip-first 5"},
                    Question{"sim_yaw_sedan", "--gt-pose mid"}),
    [](const auto& question) {  // the same set is asked about more than once
        return std::string(question.param.set) + "_" + std::to_string(question.index);
    });

}  // namespace
}  // namespace lidar_obstacles
