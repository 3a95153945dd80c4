// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay from end to end: each test runs the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mrpt/img/CImage.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>
#include <algorithm>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "support/shell.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

namespace fs = std::filesystem;
using mrpt::obs::CObservationVelodyneScan;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* kRealScan = "/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog";
constexpr const char* kColumns = "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points";

std::string read(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Outcome {
    int code = -1;
    std::string out;
    std::string err;
};

class Replay : public testing::Test {
  protected:
    Replay() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ =
            fs::temp_directory_path() / ("lidar_obstacles_" + std::string(test->name()) + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    ~Replay() override { fs::remove_all(folder_); }
    void SetUp() override { LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog")); }

    /// Runs the program; its results go to `output()`.
    Outcome run(const std::string& arguments, const std::string& before = "") const {
        const std::string command = before + " '" OBSTACLE_REPLAY "' " + arguments + " --output '" + output().string() +
                                    "' >'" + path("stdout") + "' 2>'" + path("stderr") + "'";
        return {test::shell(command), read(path("stdout")), read(path("stderr"))};
    }

    fs::path output() const { return folder_ / "results"; }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string csv() const { return read(output() / "obstacles.csv"); }
    nlohmann::json summary() const { return nlohmann::json::parse(read(output() / "summary.json")); }

    std::set<int> scanIndices() const {
        std::set<int> indices;
        std::istringstream in(csv());
        std::string line;
        std::getline(in, line);
        while (std::getline(in, line)) indices.insert(std::stoi(line.substr(line.find(',') + 1)));
        return indices;
    }

    /// A plain rawlog with copies of the real scan, 0.1 s apart, under each of the labels in turn.
    std::string writeScans(int count, const std::vector<std::string>& labels = {"lidar"}) const {
        mrpt::io::CFileGZInputStream in(kRealScan);
        auto scan =
            std::dynamic_pointer_cast<CObservationVelodyneScan>(mrpt::serialization::archiveFrom(in).ReadObject());
        const std::string file = path("copies.rawlog");
        mrpt::io::CFileOutputStream out(file);
        auto archive = mrpt::serialization::archiveFrom(out);
        for (int k = 0; k < count; ++k) {
            for (const auto& label : labels) {
                scan->sensorLabel = label;
                archive << *scan;
            }
            scan->timestamp += std::chrono::milliseconds(100);
        }
        return file;
    }

    std::string writeOne(const mrpt::obs::CObservation& observation) const {
        const std::string file = path("one.rawlog");
        mrpt::io::CFileOutputStream out(file);
        mrpt::serialization::archiveFrom(out) << observation;
        return file;
    }

  private:
    fs::path folder_;
};

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
}

TEST_F(Replay, TheRealScanGivesRowsAsTheInterfaceSays) {
    const Outcome r = run(kRealScan);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.err, "");
    std::istringstream in(csv());
    std::string line;
    std::getline(in, line);
    EXPECT_THAT(line, StartsWith(kColumns));
    const auto columns = static_cast<std::ptrdiff_t>(split(line).size());
    std::size_t rows = 0;
    std::set<std::string> ids;
    while (std::getline(in, line)) {
        const auto f = split(line);
        ASSERT_EQ(std::count(line.begin(), line.end(), ',') + 1, columns) << line;
        EXPECT_EQ(f[0], "1519637061.085268");
        EXPECT_EQ(f[1], "0");
        ids.insert(f[2]);
        EXPECT_TRUE(std::set<std::string>({"vehicle", "pedestrian", "cyclist", "structure", "unknown"}).count(f[3]))
            << line;
        for (std::size_t k = 4; k < 11; ++k) EXPECT_NO_THROW(std::stod(f[k])) << line;
        for (std::size_t k = 7; k < 10; ++k) EXPECT_GT(std::stod(f[k]), 0.0) << line;
        EXPECT_LE(std::abs(std::stod(f[10])), 3.14160) << line;
        EXPECT_TRUE(f[11] == "0" || f[11] == "1") << line;
        EXPECT_GT(std::stoi(f[12]), 0) << line;
        ++rows;
    }
    EXPECT_GT(rows, 0U);
    EXPECT_EQ(ids.size(), rows) << "an id was given twice";
    const auto obstacles = summary()["obstacles"];
    std::size_t counted = 0;
    for (const auto& count : obstacles) counted += count.get<std::size_t>();
    EXPECT_EQ(counted, rows);
}

TEST_F(Replay, ClassesChooseWhatIsTold) {
    const auto told = [&](const std::string& classes) {
        EXPECT_EQ(run(std::string(kRealScan) + " " + classes).code, 0);
        std::istringstream in(csv());
        std::multiset<std::string> found;
        std::string line;
        std::getline(in, line);
        while (std::getline(in, line)) found.insert(split(line)[3]);
        return found;
    };
    const auto all = told("");
    ASSERT_GT(all.count("structure"), 0U);
    ASSERT_GT(all.count("unknown"), 0U);
    const auto chosen = told("--classes unknown,vehicle");
    EXPECT_EQ(chosen.count("unknown"), all.count("unknown"));
    EXPECT_EQ(chosen.count("vehicle"), all.count("vehicle"));
    EXPECT_EQ(chosen.size(), all.count("unknown") + all.count("vehicle"));
    const Outcome wrong = run(std::string(kRealScan) + " --classes bicycle");
    EXPECT_EQ(wrong.code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("--classes bicycle"));
}

TEST_F(Replay, TheSummaryTellsWhatWasDone) {
    ASSERT_EQ(run(kRealScan).code, 0);
    const auto s = summary();
    EXPECT_EQ(s["scans"], 1);
    EXPECT_EQ(s["returns"], 22591);  // all returns of all 32 firings of a block
    EXPECT_EQ(s["input"], kRealScan);
    EXPECT_EQ(s["config"], "built-in defaults");
    EXPECT_TRUE(s["damage"].is_null());
    EXPECT_FALSE(s["version"].get<std::string>().empty());
    for (const char* name : {"vehicle", "pedestrian", "cyclist", "unknown"}) EXPECT_TRUE(s["obstacles"].contains(name));
    EXPECT_EQ(s["ground"]["good"].get<int>() + s["ground"]["weak"].get<int>() + s["ground"]["none"].get<int>(), 1);
    double stages = 0.0;
    for (const auto& [stage, time] : s["timing_ms"].items()) {
        EXPECT_GE(time["p95"].get<double>(), time["median"].get<double>()) << stage;
        EXPECT_GE(time["p99"].get<double>(), time["p95"].get<double>()) << stage;
        if (stage != "total") stages += time["median"].get<double>();
    }
    EXPECT_GT(s["timing_ms"]["decode"]["median"].get<double>(), 0.0);
    EXPECT_GE(s["timing_ms"]["total"]["median"].get<double>(), 0.99 * stages);  // one scan: total = sum + the rest
    for (const auto& p : listParams(DetectorParams{})) EXPECT_TRUE(s["parameters"][p.section].contains(p.key)) << p.key;
}

TEST_F(Replay, TheSameInputGivesTheSameBytes) {
    ASSERT_EQ(run(kRealScan).code, 0);
    const std::string first = csv();
    ASSERT_EQ(run(kRealScan).code, 0);
    EXPECT_EQ(csv(), first);
    ASSERT_EQ(run(std::string(kRealScan) + " --config '" LIDAR_OBSTACLES_CONFIG_INI "'").code, 0);
    EXPECT_EQ(csv(), first) << "config.ini and the built-in defaults differ";
    EXPECT_EQ(summary()["config"], LIDAR_OBSTACLES_CONFIG_INI);
}

TEST_F(Replay, ParametersCanBeChangedOnTheCommandLine) {
    ASSERT_EQ(run(std::string(kRealScan) + " --set sensor.max_range=20 --set grid.free=rays --planes 8").code, 0);
    const auto s = summary();
    EXPECT_EQ(s["parameters"]["sensor"]["max_range"], 20.0);
    EXPECT_EQ(s["parameters"]["grid"]["free"], "rays");
    EXPECT_EQ(s["parameters"]["sensor"]["planes"], 8);
    EXPECT_LT(s["returns"].get<int>(), 22591 / 2);
}

TEST_F(Replay, WrongCommandLinesEndWithTwoAndSayWhy) {
    const std::string scan = kRealScan;
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"", "INPUT is missing"},
        {scan + " --nonsense", "--nonsense"},
        {scan + " two.rawlog", "two.rawlog"},
        {scan + " --planes many", "many"},
        {scan + " --planes 5", "5"},  // does not divide 16
        {scan + " --every 0", "every"},
        {scan + " --from -1", "from"},
        {scan + " --from 5 --to 4", "before"},
        {scan + " --from 5", "leave none of its scans"},
        {scan + " --scenes some", "--scenes some: must be none, all or a number"},
        {scan + " --pictures 0", "--pictures 0: must be"},
        {scan + " --set sensor.max_rnage=5", "did you mean 'max_range'"},
        {scan + " --set senser.max_range=5", "did you mean '[sensor]'"},
        {scan + " --set sensor.max_range=0,5", "[sensor] max_range = 0,5: not a number"},
        {scan + " --set sensor.max_range", "section.key=value"},
        {scan + " --config /nonexistent.ini", "/nonexistent.ini: cannot open"},
        {scan + " --sensor-label front", "no lidar 'front'; there are: 'Velodyne1_SCAN' (1 scans)"},
    };
    for (const auto& [arguments, message] : cases) {
        const Outcome r = run(arguments);
        EXPECT_EQ(r.code, 2) << arguments << "\n" << r.err;
        EXPECT_THAT(r.err, AllOf(StartsWith("obstacle-replay: error: "), HasSubstr(message))) << arguments;
        EXPECT_FALSE(fs::exists(output() / "obstacles.csv")) << arguments;
    }
}

TEST_F(Replay, AMistakeInAConfigFileIsNamedWithItsLine) {
    std::string text = dumpParams(DetectorParams{});
    text.replace(text.find("max_range = "), 12, "max_rnage = ");
    std::ofstream(path("my.ini")) << text;
    const Outcome r = run(std::string(kRealScan) + " --config '" + path("my.ini") + "'");
    EXPECT_EQ(r.code, 2);
    const auto before = text.substr(0, text.find("max_rnage"));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    EXPECT_THAT(r.err,
                AllOf(HasSubstr("my.ini:" + std::to_string(line) + ": [sensor] max_rnage"), HasSubstr("'max_range'")));
}

TEST_F(Replay, InputsWithoutScansAreErrors) {
    const Outcome missing = run("/nonexistent.rawlog");
    EXPECT_EQ(missing.code, 1);
    EXPECT_THAT(missing.err, HasSubstr("/nonexistent.rawlog"));
    std::ofstream(path("empty.rawlog")).close();
    const Outcome empty = run("'" + path("empty.rawlog") + "'");
    EXPECT_EQ(empty.code, 1);
    EXPECT_THAT(empty.err, HasSubstr("empty.rawlog"));
    const Outcome other = run("'" + writeOne(mrpt::obs::CObservationRobotPose()) + "'");
    EXPECT_EQ(other.code, 1);
    EXPECT_THAT(other.err, AllOf(HasSubstr("one.rawlog"), HasSubstr("no lidar scans")));
    const Outcome folder = run("/tmp");
    EXPECT_EQ(folder.code, 1);
    EXPECT_THAT(folder.err, HasSubstr("/tmp"));
}

TEST_F(Replay, WhatIsNoRecordingGetsOneSentenceAndNoResults) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), "a PNG picture, neither a rawlog nor a Velodyne capture"},
        {"#ROSBAG V2.0\n", "a ROS bag, neither"},
        {"timestamp,scan_index\n", ": neither a rawlog nor a Velodyne capture"}};
    for (const auto& [content, message] : cases) {
        std::ofstream(path("drive.rawlog"), std::ios::binary) << content;
        const Outcome r = run("'" + path("drive.rawlog") + "'");
        EXPECT_EQ(r.code, 1);
        EXPECT_THAT(r.err, AllOf(StartsWith("obstacle-replay: error: " + path("drive.rawlog")), HasSubstr(message)));
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
        EXPECT_FALSE(fs::exists(output() / "obstacles.csv"));
    }
}

TEST_F(Replay, ADamageBeforeTheFirstScanLeavesNoEmptyResults) {
    const std::string file = writeScans(1);
    fs::resize_file(file, 3000);
    const Outcome r = run("'" + file + "' --format csv,jsonl");
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, HasSubstr("object 0 cannot be read"));
    EXPECT_EQ(std::distance(fs::directory_iterator(output()), {}), 0);
}

TEST_F(Replay, AMisspeltOptionGetsASuggestion) {
    const Outcome r = run(std::string(kRealScan) + " --pictrues all");
    EXPECT_EQ(r.code, 2);
    EXPECT_THAT(r.err, HasSubstr("did you mean --pictures?"));
    EXPECT_THAT(run(std::string(kRealScan) + " --evry=2").err, HasSubstr("did you mean --every?"));
    EXPECT_THAT(run(std::string(kRealScan) + " --nonsense").err, Not(HasSubstr("did you mean")));
}

TEST_F(Replay, AScanWithoutReturnsPassesThrough) {
    CObservationVelodyneScan scan;
    scan.sensorLabel = "lidar";
    const Outcome r = run("'" + writeOne(scan) + "' --scenes all --grids all --pictures all");
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(summary()["scans"], 1);
    EXPECT_EQ(summary()["returns"], 0);
    EXPECT_EQ(summary()["ground"]["none"], 1);
    EXPECT_THAT(csv(), StartsWith(kColumns));
    EXPECT_TRUE(scanIndices().empty());
    EXPECT_TRUE(fs::exists(output() / "picture_000000.png"));
    mrpt::obs::CObservationPointCloud cloud;
    cloud.pointcloud = mrpt::maps::CSimplePointsMap::Create();
    EXPECT_EQ(run("'" + writeOne(cloud) + "'").code, 0);
}

TEST_F(Replay, FromToAndEveryChooseScansByTheirNumber) {
    const std::string input = "'" + writeScans(8) + "'";
    ASSERT_EQ(run(input).code, 0);
    EXPECT_EQ(scanIndices(), (std::set<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    ASSERT_EQ(run(input + " --from 1 --to 6 --every 2").code, 0);
    EXPECT_EQ(scanIndices(), (std::set<int>{1, 3, 5}));
    EXPECT_EQ(summary()["scans"], 3);
    EXPECT_EQ(summary()["returns"], 3 * 22591);
    EXPECT_THAT(csv(), HasSubstr("\n1519637061.185268,1,"));
    ASSERT_EQ(run(input + " --to 0").code, 0);
    EXPECT_EQ(scanIndices(), (std::set<int>{0}));
}

TEST_F(Replay, FilesPerScanAreWrittenForEveryKthProcessedScan) {
    const std::string input = "'" + writeScans(6) + "'";
    ASSERT_EQ(run(input + " --from 1 --scenes 2 --grids 3 --pictures none").code, 0);
    std::set<std::string> files;
    for (const auto& entry : fs::directory_iterator(output())) files.insert(entry.path().filename().string());
    EXPECT_EQ(files, (std::set<std::string>{"obstacles.csv", "summary.json", "scene_000001.3Dscene",
                                            "scene_000003.3Dscene", "scene_000005.3Dscene", "grid_000001.png",
                                            "grid_000001.yaml", "grid_000004.png", "grid_000004.yaml"}));
}

TEST_F(Replay, ASecondInputLeavesNothingOfTheFirstBesideItsOwnFiles) {
    ASSERT_EQ(run("'" + writeScans(6) + "' --scenes all --grids all --pictures 5 --format csv,jsonl,kitti --record '" +
                  path("frames") + "' --size 320x240")
                  .code,
              0);
    std::ofstream(output() / "notes.txt") << "a user's";
    std::ofstream(output() / "picture_of_me.png") << "a user's";
    ASSERT_EQ(
        run("'" + writeScans(2) + "' --format csv --pictures 2 --record '" + path("frames") + "' --size 320x240").code,
        0);
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(output()))
        if (entry.is_regular_file()) files.insert(entry.path().filename().string());
    EXPECT_EQ(files, (std::set<std::string>{"obstacles.csv", "summary.json", "picture_000000.png", "notes.txt",
                                            "picture_of_me.png"}));
    EXPECT_EQ(std::distance(fs::directory_iterator(path("frames")), {}), 2);
}

TEST_F(Replay, SizeIsThatOfThePictures) {
    ASSERT_EQ(run(std::string(kRealScan) + " --pictures all --size 640x360").code, 0);
    mrpt::img::CImage picture;
    ASSERT_TRUE(picture.loadFromFile((output() / "picture_000000.png").string()));
    EXPECT_EQ(picture.getWidth(), 640U);
    EXPECT_EQ(picture.getHeight(), 360U);
}

TEST_F(Replay, SceneGridAndPictureShowTheScan) {
    ASSERT_EQ(run(std::string(kRealScan) + " --scenes all --grids all --pictures all").code, 0);
    mrpt::opengl::COpenGLScene scene;
    ASSERT_TRUE(scene.loadFromFile((output() / "scene_000000.3Dscene").string()));
    for (const char* name : {"ground", "clustered", "grid", "box_0"}) EXPECT_TRUE(scene.getByName(name)) << name;

    const auto map = mrpt::maps::COccupancyGridMap2D::FromROSMapServerYAML((output() / "grid_000000.yaml").string());
    const auto region = summary()["parameters"]["region"];
    EXPECT_NEAR(map.getXMin(), -region["rear"].get<double>(), map.getResolution());
    EXPECT_NEAR(map.getYMin(), -region["lateral"].get<double>(), map.getResolution());
    int occupied = 0;
    int free = 0;
    for (unsigned y = 0; y < map.getSizeY(); ++y) {
        for (unsigned x = 0; x < map.getSizeX(); ++x) {
            const float p_free = map.getCell(static_cast<int>(x), static_cast<int>(y));
            occupied += p_free < 0.1F;
            free += p_free > 0.9F;
        }
    }
    EXPECT_GT(occupied, 100);
    EXPECT_GT(free, 100);

    mrpt::img::CImage picture;
    ASSERT_TRUE(picture.loadFromFile((output() / "picture_000000.png").string()));
    EXPECT_EQ(picture.getWidth(), 1280U);
    const auto* background = picture.ptrLine<std::uint8_t>(0);
    int drawn = 0;
    for (unsigned y = 0; y < picture.getHeight(); ++y) {
        const auto* row = picture.ptrLine<std::uint8_t>(y);
        for (unsigned x = 0; x < picture.getWidth(); ++x) drawn += std::abs(row[3 * x + 2] - background[2]) > 30;
    }
    EXPECT_GT(drawn, 5000);
}

TEST_F(Replay, TheOwnBodyOfARealCarIsSeenLearntAndLeftOut) {
    LIDAR_OBSTACLES_NEED(drive, labelledData("kitti_0001_16.rawlog"));
    const auto nearScans = [this] {  // scans with an obstacle of five returns or more within 2 m of the origin
        std::set<std::string> scans;
        std::istringstream in(csv());
        std::string line;
        std::getline(in, line);
        while (std::getline(in, line))
            if (std::stod(split(line).at(15)) < 2.0 && std::stoi(split(line).at(12)) >= 5)
                scans.insert(split(line).at(1));
        return scans.size();
    };
    const Outcome seen = run("'" + drive + "'");
    ASSERT_EQ(seen.code, 0) << seen.err;
    EXPECT_EQ(nearScans(), 107U);
    EXPECT_THAT(seen.err, AllOf(HasSubstr("its own body?"), HasSubstr("--learn-own-body")));
    EXPECT_THAT(summary()["remarks"].get<std::string>(), HasSubstr("its own body?"));
    const Outcome learnt = run("'" + drive + "' --learn-own-body");
    ASSERT_EQ(learnt.code, 0) << learnt.err;
    EXPECT_THAT(learnt.out, HasSubstr("own_body.txt"));
    fs::copy_file(output() / "own_body.txt", path("body.txt"));
    const Outcome masked = run("'" + drive + "' --set region.own_body=@" + path("body.txt"));
    ASSERT_EQ(masked.code, 0) << masked.err;
    EXPECT_LT(nearScans(), 15U) << "scraps of five or six returns at the mask's edge, of 107 scans";
    EXPECT_TRUE(summary()["remarks"].is_null()) << summary()["remarks"];
    EXPECT_FALSE(fs::exists(output() / "own_body.txt")) << "of the run before";
}

TEST_F(Replay, SeveralLidarsNeedALabel) {
    const std::string input = "'" + writeScans(2, {"front", "rear"}) + "'";
    const Outcome r = run(input);
    EXPECT_EQ(r.code, 2);
    EXPECT_THAT(r.err,
                AllOf(HasSubstr("--sensor-label"), HasSubstr("'front' (2 scans)"), HasSubstr("'rear' (2 scans)")));
    EXPECT_FALSE(fs::exists(output() / "obstacles.csv"));
    ASSERT_EQ(run(input + " --sensor-label rear").code, 0);
    EXPECT_EQ(summary()["scans"], 2);
    EXPECT_EQ(summary()["sensor_label"], "rear");
    EXPECT_EQ(scanIndices(), (std::set<int>{0, 1}));
}

TEST_F(Replay, WhatStandsBeforeADamageIsProcessed) {
    const std::string file = writeScans(4);
    ASSERT_EQ(run("'" + file + "'").code, 0);
    const std::string whole = csv();
    fs::resize_file(file, fs::file_size(file) * 5 / 8);  // in the middle of the third scan
    const Outcome r = run("'" + file + "'");
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, AllOf(HasSubstr("copies.rawlog"), HasSubstr("object 2")));
    EXPECT_EQ(csv(), whole.substr(0, whole.find("\n1519637061.285268,2,") + 1));
    EXPECT_EQ(summary()["scans"], 2);
    EXPECT_THAT(summary()["damage"].get<std::string>(), HasSubstr("object 2"));
}

TEST_F(Replay, AnOutputFolderThatCannotBeMadeIsAnError) {
    std::ofstream(output().string()) << "a file";
    const Outcome r = run(kRealScan);
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, AllOf(HasSubstr(output().string()), HasSubstr("output folder")));
}

TEST_F(Replay, PicturesWithoutAnyRendererAreAnError) {
    const Outcome r = run(std::string(kRealScan) + " --pictures all", "__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null");
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, HasSubstr("off-screen rendering (EGL) is not available"));
}

TEST_F(Replay, AFullDiskIsAnError) {
    fs::create_directories(output());
    fs::create_symlink("/dev/full", output() / "obstacles.csv.part");
    const Outcome r = run(kRealScan);
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, AllOf(HasSubstr("obstacles.csv"), HasSubstr("No space left on device")));
}

TEST_F(Replay, ADiskThatRunsFullLeavesWholeScans) {
    const std::string input = "'" + writeScans(30) + "'";
    ASSERT_EQ(run(input).code, 0);
    const std::string whole = csv();
    const std::size_t blocks = whole.size() / 512 / 2;  // room for half of it
    ASSERT_GT(blocks, 4U);
    const Outcome r = run(input, "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + ";");
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, HasSubstr("obstacles.csv: cannot write"));
    const std::string kept = csv();
    ASSERT_GT(kept.size(), 1000U);
    ASSERT_LT(kept.size(), whole.size());
    EXPECT_EQ(kept, whole.substr(0, kept.size()));
    EXPECT_EQ(kept.back(), '\n');
    const auto scanAt = [&](std::size_t at) { return split(whole.substr(at, whole.find('\n', at) - at)).at(1); };
    EXPECT_NE(scanAt(kept.size()), scanAt(kept.rfind('\n', kept.size() - 2) + 1)) << "half a scan was kept";
}

TEST_F(Replay, HelpVersionAndConfigArePrinted) {
    const Outcome help = run("--help");
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, AllOf(HasSubstr("Examples:"), HasSubstr("--sensor-label"), HasSubstr("obstacles.csv")));
    const Outcome version = run("--version");
    EXPECT_EQ(version.code, 0);
    EXPECT_THAT(version.out, StartsWith("obstacle-replay "));
    const Outcome config = run("--print-config");
    EXPECT_EQ(config.code, 0);
    EXPECT_EQ(config.out, dumpParams(DetectorParams{}));
    EXPECT_THAT(run("--print-config --set sensor.max_range=33").out, HasSubstr("\nmax_range = 33\n"));
}

}  // namespace
}  // namespace lidar_obstacles
