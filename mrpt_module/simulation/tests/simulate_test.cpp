// SPDX-License-Identifier: BSD-3-Clause
// obstacle-simulate from end to end: each test runs the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"
#include "lidar_obstacles/simulation/labels.h"
#include "support/small_worlds.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles::simulation {
namespace {

namespace fs = std::filesystem;
using lidar_obstacles::test::readFile;
using lidar_obstacles::test::TempFolder;
using lidar_obstacles::test::writeFile;
using testing::AllOf;
using testing::HasSubstr;

struct Outcome {
    int code = -1;
    std::string err;
};

class Simulate : public testing::Test {
  protected:
    Outcome run(const std::string& arguments) {
        const std::string command =
            std::string(OBSTACLE_SIMULATE) + " " + arguments + " >/dev/null 2>" + folder_.file("err");
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readFile(folder_.file("err"))};
    }
    std::string file(const std::string& name) const { return folder_.file(name); }
    static std::string scenario(const std::string& name) { return std::string(SCENARIOS) + name + ".yaml"; }

    TempFolder folder_;
};

TEST_F(Simulate, TheSameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
    const std::string arguments = scenario("street") + " --from 20 --to 21.2 --stride 2 --odometry --output ";
    ASSERT_EQ(run(arguments + file("a") + " --threads 1").code, 0);
    ASSERT_EQ(run(arguments + file("b") + " --threads 4").code, 0);
    ASSERT_EQ(run(arguments + file("c") + " --seed 2").code, 0);
    for (const char* end : {".rawlog", "_gt.csv", "_static.csv", "_ego.csv"}) {
        const std::string a = readFile(file("a") + end);
        EXPECT_FALSE(a.empty());
        EXPECT_EQ(a, readFile(file("b") + end)) << end;
    }
    EXPECT_NE(readFile(file("a.rawlog")), readFile(file("c.rawlog")));
    EXPECT_EQ(readFile(file("a_static.csv")), readFile(file("c_static.csv")));
}

TEST_F(Simulate, TheRawlogHoldsScansAndPosesInTheOrderOfTheirTimes) {
    ASSERT_EQ(run(scenario("street") + " --from 5 --to 6 --odometry --output " + file("a")).code, 0);
    RawlogReader reader(file("a.rawlog"));
    int scans = 0, poses = 0, odometry = 0;
    double last = 0.0;
    while (const auto item = reader.next()) {
        ASSERT_TRUE(item->observation);
        const double time = mrpt::Clock::toDouble(item->observation->timestamp);
        EXPECT_GE(time, last);
        last = time;
        if (const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservationVelodyneScan>(item->observation)) {
            ++scans;
            EXPECT_GT(toPointCloud(*scan, SensorParams{}).size(), 10000U);
        }
        poses += std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(item->observation) ? 1 : 0;
        odometry += std::dynamic_pointer_cast<mrpt::obs::CObservationOdometry>(item->observation) ? 1 : 0;
    }
    EXPECT_EQ(reader.status(), SourceStatus::End);
    EXPECT_EQ(scans, 10);
    EXPECT_NEAR(poses, 20, 1);
    EXPECT_EQ(odometry, poses);
}

TEST_F(Simulate, ASetOnTheCommandLineCountsMoreThanTheScenario) {
    ASSERT_EQ(run(scenario("street") + " --to 0.3 --rate 20 --height 1.2 --planes 8 --output " + file("a")).code, 0);
    RawlogReader reader(file("a.rawlog"));
    int scans = 0;
    while (const auto item = reader.next())
        if (const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservationVelodyneScan>(item->observation)) {
            ++scans;
            EXPECT_DOUBLE_EQ(scan->sensorPose.z(), 1.2);
        }
    EXPECT_EQ(scans, 6);
}

TEST_F(Simulate, AFasterSensorStillGoesThroughEveryPoseOfAGridOnce) {
    const char* text =
        "track: {width: 20, segments: [{straight: 60}]}\nsensor: {pose: {z: 1.9}}\nego: {path: [{t: 0, s: 30}]}\n"
        "objects: [{model: sedan, grid: {ranges: [5, 9], bearings: [0, 90], yaws: [0, 45, 90]}}]\n";
    writeFile(file("grid.yaml"), text);
    ASSERT_EQ(run(file("grid.yaml") + " --rate 20 --output " + file("a")).code, 0);
    const std::string truth = readFile(file("a_gt.csv"));
    ASSERT_EQ(std::count(truth.begin(), truth.end(), '\n'), 13);
    for (std::size_t row = 0; row < 12; ++row)
        EXPECT_NEAR(test::csvNumber(truth, row, "range_nearest"), row < 6 ? 5.0 : 9.0, 1e-3);
}

TEST_F(Simulate, ARandomSceneHasItsTruthAndALabelPerReturn) {
    for (const char* name : {"a", "b"})
        ASSERT_EQ(run("--random car-park --seed 7 --planes 8 --to 0.5 --output " + file(name)).code, 0);
    for (const char* end : {".rawlog", "_gt.csv", "_static.csv", "_ego.csv", "_labels.bin"})
        EXPECT_EQ(readFile(file("a") + end), readFile(file("b") + end)) << end;
    ASSERT_EQ(run("--random car-park --seed 8 --planes 8 --to 0.5 --output " + file("c")).code, 0);
    EXPECT_NE(readFile(file("a_static.csv")), readFile(file("c_static.csv"))) << "another seed is another scene";

    RawlogReader reader(file("a.rawlog"));
    LabelsReader labels(file("a_labels.bin"));
    const std::string ego = readFile(file("a_ego.csv")), truth = readFile(file("a_gt.csv"));
    std::map<int, int> seen;
    std::size_t scans = 0;
    while (const auto item = reader.next()) {
        const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservationVelodyneScan>(item->observation);
        if (!scan) continue;
        SensorParams params;
        params.min_range = 0.0;
        const auto told = labels.next();
        ASSERT_TRUE(told);
        EXPECT_EQ(told->returns.size(), toPointCloud(*scan, params).size());
        EXPECT_EQ(static_cast<double>(told->returns.size()), test::csvNumber(ego, scans, "num_returns"));
        EXPECT_NEAR(told->timestamp, test::csvNumber(ego, scans, "timestamp"), 1e-6);
        if (scans++ == 0)
            for (const ReturnLabel& r : told->returns) ++seen[r.id];
    }
    EXPECT_FALSE(labels.next());
    for (std::size_t row = 0; test::csvNumber(truth, row, "scan_index") == 0.0; ++row)
        EXPECT_EQ(seen[static_cast<int>(test::csvNumber(truth, row, "object_id"))],
                  static_cast<int>(test::csvNumber(truth, row, "num_points")));
}

TEST_F(Simulate, BadInputEndsWithTwoAndSaysWhy) {
    EXPECT_EQ(run("--random moon --output " + file("a")).code, 2);
    EXPECT_EQ(run("--random park " + scenario("street") + " --output " + file("a")).code, 2);
    EXPECT_EQ(run("").code, 2);
    EXPECT_EQ(run("/no/such.yaml").code, 2);
    EXPECT_EQ(run(scenario("street") + " --planes 7 --output " + file("a")).code, 2);
    EXPECT_EQ(run(scenario("street") + " --mount-error 1,2 --output " + file("a")).code, 2);
    EXPECT_EQ(run(scenario("street") + " --from 3 --to 2 --output " + file("a")).code, 2);
    const Outcome late = run(scenario("street") + " --from 5000 --output " + file("a"));
    EXPECT_EQ(late.code, 2);
    EXPECT_THAT(late.err, HasSubstr("--from"));
    writeFile(file("bad.yaml"), "duration: 10\ntrack: {width: wide}\n");
    const Outcome bad = run(file("bad.yaml") + " --output " + file("a"));
    EXPECT_EQ(bad.code, 2);
    EXPECT_THAT(bad.err, AllOf(HasSubstr("bad.yaml:2"), HasSubstr("track.width")));
    EXPECT_FALSE(fs::exists(file("a.rawlog")));
}

TEST_F(Simulate, ADiskThatIsFullEndsWithOneAndLeavesNoRawlog) {
    fs::create_symlink("/dev/full", file("a.rawlog.part"));
    const Outcome outcome = run(scenario("street") + " --to 3 --output " + file("a"));
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("a.rawlog"), HasSubstr("No space left")));
    for (const char* end : {".rawlog", "_gt.csv", "_static.csv", "_ego.csv", "_labels.bin"})
        EXPECT_FALSE(fs::exists(file("a") + end));
    writeFile(file("plain"), "");
    EXPECT_EQ(run(scenario("street") + " --to 0.3 --output " + file("plain") + "/a").code, 1);
}

TEST(Sample, FitsItsTruth) {
    const std::string prefix = std::string(DATASETS) + "street_sample", ego = readFile(prefix + "_ego.csv");
    EXPECT_LT(fs::file_size(prefix + ".rawlog"), 1'000'000U);
    RawlogReader reader(prefix + ".rawlog");
    std::size_t scans = 0;
    while (const auto item = reader.next()) {
        const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservationVelodyneScan>(item->observation);
        if (!scan) continue;
        const PointCloud cloud = toPointCloud(*scan, SensorParams{});
        EXPECT_NEAR(cloud.timestamp, test::csvNumber(ego, scans, "timestamp"), 1e-6);
        // The decoder leaves out what is nearer than its own limit.
        EXPECT_NEAR(static_cast<double>(cloud.size()), test::csvNumber(ego, scans, "num_returns"), 20.0);
        ++scans;
    }
    EXPECT_EQ(reader.status(), SourceStatus::End);
    EXPECT_EQ(scans, static_cast<std::size_t>(std::count(ego.begin(), ego.end(), '\n')) - 1);
}

/// Detections that are the truth: every object with at least one return.
std::string perfectDetections(const std::string& truth) {
    std::string csv = "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points\n";
    const auto rows = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), '\n')) - 1;
    for (std::size_t row = 0; row < rows; ++row) {
        if (test::csvNumber(truth, row, "num_points") < 1.0) continue;
        for (const char* column : {"timestamp", "scan_index", "object_id", "type", "x_obs", "y_obs", "z_obs", "length",
                                   "width", "height", "yaw_obs"})
            csv += test::csvValue(truth, row, column) + ",";
        csv += "1," + test::csvValue(truth, row, "num_points") + "\n";
    }
    return csv;
}

TEST(Sample, IsReadByTheEvaluationScript) {
    LIDAR_OBSTACLES_NEED(script, labelledData("../eval/eval_boxes.py"));
    const TempFolder folder;
    const std::string prefix = std::string(DATASETS) + "street_sample";
    writeFile(folder.file("detections.csv"), perfectDetections(readFile(prefix + "_gt.csv")));
    const std::string command = "/usr/bin/python3 " + script + " --prefix " + prefix + " --det " +
                                folder.file("detections.csv") + " --json " + folder.file("result") + " >/dev/null";
    ASSERT_EQ(std::system(command.c_str()), 0);
    const std::string result = readFile(folder.file("result"));
    EXPECT_THAT(result, HasSubstr("\"recall\": 1.0"));
    EXPECT_THAT(result, HasSubstr("\"fp_per_scan\": 0.0"));
    EXPECT_THAT(result, testing::Not(HasSubstr("\"recall\": 0.")));
}

}  // namespace
}  // namespace lidar_obstacles::simulation
