// SPDX-License-Identifier: BSD-3-Clause
// Runs that are interrupted by a signal: what they leave is whole, and says where they ended.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/serialization/CArchive.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/program.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

namespace fs = std::filesystem;
using test::readFile;
using testing::EndsWith;
using testing::HasSubstr;

constexpr int kMany = 500;  // scans: more than any run gets through before the signal

class Interrupt : public testing::Test {
  protected:
    std::string path(const std::string& name) const { return folder_.file(name); }

    /// Copies of the real scan, 0.1 s apart, as many as a run cannot finish.
    std::string manyScans() const {
        mrpt::io::CFileGZInputStream in("/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog");
        auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservationVelodyneScan>(
            mrpt::serialization::archiveFrom(in).ReadObject());
        mrpt::io::CFileOutputStream out(path("many.rawlog"));
        auto archive = mrpt::serialization::archiveFrom(out);
        for (int k = 0; k < kMany; ++k) {
            archive << *scan;
            scan->timestamp += std::chrono::milliseconds(100);
        }
        return path("many.rawlog");
    }

    static void waitForSize(const std::string& file, std::uintmax_t size) {
        std::error_code error;
        for (int k = 0; k < 6000; ++k) {
            const auto now = fs::file_size(file, error);
            if (!error && now >= size) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }

    /// Starts a tool, sends a signal once a file has grown to `size` bytes, and returns the exit code.
    int interrupt(const std::vector<std::string>& command, const std::string& file, std::uintmax_t size,
                  int signal = SIGINT) const {
        test::Program program(command, path("stdout"), path("stderr"));
        waitForSize(file, size);
        program.interrupt(signal);
        return program.wait();
    }

    /// The N of "TOOL: interrupted at scan N" on the standard error.
    std::size_t interruptedAt(const std::string& tool) const {
        const std::string said = readFile(path("stderr"));
        const std::string mark = tool + ": interrupted at scan ";
        const auto at = said.find(mark);
        EXPECT_NE(at, std::string::npos) << said;
        return at == std::string::npos ? 0 : std::stoul(said.substr(at + mark.size()));
    }

    /// Lidar scans of a rawlog that must end with a whole object.
    static std::size_t scansIn(const std::string& rawlog) {
        const auto source = openScanSource(rawlog);
        std::size_t scans = 0;
        while (const auto item = source->next()) scans += item->observation && isLidarScan(*item->observation);
        EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
        return scans;
    }
    void expectNothingHalf() const {
        for (const auto& entry : fs::recursive_directory_iterator(path("")))
            EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    }
    /// scan_index of the last row of a CSV file (second column), which ends with a whole line.
    static std::size_t lastScanOf(const std::string& csv) {
        const std::string text = readFile(csv);
        EXPECT_THAT(text, EndsWith("\n"));
        const auto row = text.rfind('\n', text.size() - 2) + 1;
        return std::stoul(text.substr(text.find(',', row) + 1));
    }

    test::TempFolder folder_;
};

class InterruptBySignal : public Interrupt, public testing::WithParamInterface<int> {};

TEST_P(InterruptBySignal, AReplayLeavesWholeFilesUpToTheScanThatItNames) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    const std::string out = path("out");
    const int code = interrupt({OBSTACLE_REPLAY, manyScans(), "--output", out, "--format", "csv,jsonl,kitti,mcap,ply",
                                "--annotate", path("annotated.rawlog"), "--report", path("page.html")},
                               out + "/obstacles.csv.part", 20000, GetParam());
    EXPECT_EQ(code, 130);
    const std::size_t n = interruptedAt("obstacle-replay");
    ASSERT_GT(n, 0U);
    ASSERT_LT(n, static_cast<std::size_t>(kMany));
    const auto summary = nlohmann::json::parse(readFile(out + "/summary.json"));
    EXPECT_EQ(summary["interrupted_at"], n);
    EXPECT_EQ(summary["scans"], n);
    EXPECT_TRUE(summary["damage"].is_null());
    EXPECT_EQ(lastScanOf(out + "/obstacles.csv"), n - 1);
    const std::string lines = readFile(out + "/obstacles.jsonl");
    EXPECT_EQ(static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n')), n);
    for (const char* folder : {"/kitti", "/ply"})
        EXPECT_EQ(static_cast<std::size_t>(std::distance(fs::directory_iterator(out + folder), {})), n);
    EXPECT_THAT(readFile(out + "/obstacles.mcap"), EndsWith(std::string("\x89MCAP0\r\n", 8)));
    const std::string page = readFile(path("page.html"));
    EXPECT_THAT(page, EndsWith("</html>\n"));
    EXPECT_THAT(page, HasSubstr("The run was interrupted at scan " + std::to_string(n) + "."));
    EXPECT_THAT(page, HasSubstr("\"scans\":" + std::to_string(n) + ","));
    EXPECT_EQ(scansIn(path("annotated.rawlog")), n);
    expectNothingHalf();
}

INSTANTIATE_TEST_SUITE_P(Signals, InterruptBySignal, testing::Values(SIGINT, SIGTERM),
                         [](const auto& test) { return test.param == SIGINT ? "Interrupt" : "Terminate"; });

TEST_F(Interrupt, AVideoIsCompletedAlsoWhereTheSignalGoesToAllOfTheGroup) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    LIDAR_OBSTACLES_NEED(ffmpeg, programNamed("ffmpeg"));
    const std::string out = path("out");
    test::Program program({"/usr/bin/setsid", OBSTACLE_REPLAY, manyScans(), "--output", out, "--size", "320x240",
                           "--record", path("video.mp4")},
                          path("stdout"), path("stderr"));
    waitForSize(out + "/obstacles.csv.part", 20000);
    program.interruptGroup();
    EXPECT_EQ(program.wait(), 130);
    EXPECT_GT(interruptedAt("obstacle-replay"), 0U);
    EXPECT_GT(fs::file_size(path("video.mp4")), 1000U);
    EXPECT_THAT(readFile(path("video.mp4")), HasSubstr("moov")) << "the index of a video that was completed";
    expectNothingHalf();
}

#ifdef OBSTACLE_EVALUATE
TEST_F(Interrupt, AnEvaluationJudgesTheScansUpToThere) {
    LIDAR_OBSTACLES_NEED(scan, mrptDataset("test_velodyne_VLP16.rawlog"));
    const std::string rawlog = manyScans();
    std::string truth = "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points\n";
    for (int k = 0; k < kMany; ++k) {
        char row[128];
        std::snprintf(row, sizeof row, "%.6f,%d,1,car,8,3,-1.5,4,2,1.5,0,0,0,50\n", 1519637061.085268 + 0.1 * k, k);
        truth += row;
    }
    test::writeFile(path("many_gt.csv"), truth);
    const std::string out = path("out");
    const int code = interrupt({OBSTACLE_EVALUATE, "--prefix", path("many"), "--output", out},
                               out + "/many/obstacles.csv.part", 20000);
    EXPECT_EQ(code, 130);
    const std::size_t n = interruptedAt("obstacle-evaluate");
    EXPECT_EQ(lastScanOf(out + "/many/obstacles.csv"), n - 1);
    const auto metrics = nlohmann::json::parse(readFile(out + "/metrics.json"));
    EXPECT_EQ(metrics["scans"], n);
    EXPECT_EQ(metrics["interrupted"]["scan"], n);
    EXPECT_EQ(metrics["interrupted"]["set"], "many");
    EXPECT_FALSE(fs::exists(out + "/report.html"));
    expectNothingHalf();
}
#endif

#ifdef KITTI2RAWLOG
TEST_F(Interrupt, AConversionKeepsTheScansUpToThere) {
    fs::create_directories(path("in/velodyne"));
    std::vector<float> point = {10.F, 0.F, 0.F, 0.5F};
    std::string bytes;
    for (int k = 0; k < 60000; ++k) bytes.append(reinterpret_cast<const char*>(point.data()), 16);
    test::writeFile(path("scan.bin"), bytes);
    for (int k = 0; k < kMany; ++k) {
        char name[32];
        std::snprintf(name, sizeof name, "in/velodyne/%06d.bin", k);
        fs::create_symlink(path("scan.bin"), path(name));
    }
    const int code = interrupt({KITTI2RAWLOG, path("in"), "--layout", "object", "--output", path("set")},
                               path("set.rawlog.part"), 10000);
    EXPECT_EQ(code, 130);
    const std::size_t n = interruptedAt("kitti2rawlog");
    ASSERT_GT(n, 0U);
    EXPECT_EQ(scansIn(path("set.rawlog")), n);
    EXPECT_TRUE(fs::exists(path("set_gt.csv")));
    expectNothingHalf();
}
#endif

#ifdef OBSTACLE_SIMULATE
TEST_F(Interrupt, ASimulationLeavesScansTruthAndPosesThatGoTogether) {
    const int code = interrupt({OBSTACLE_SIMULATE, SCENARIOS "street.yaml", "--output", path("street")},
                               path("street_ego.csv.part"), 400);
    EXPECT_EQ(code, 130);
    const std::size_t n = interruptedAt("obstacle-simulate");
    ASSERT_GT(n, 0U);
    EXPECT_EQ(scansIn(path("street.rawlog")), n);
    const std::string poses = readFile(path("street_ego.csv"));
    EXPECT_EQ(static_cast<std::size_t>(std::count(poses.begin(), poses.end(), '\n')), n + 1);
    EXPECT_EQ(lastScanOf(path("street_gt.csv")), n - 1);
    EXPECT_TRUE(fs::exists(path("street_static.csv")));
    expectNothingHalf();
}
#endif

}  // namespace
}  // namespace lidar_obstacles
