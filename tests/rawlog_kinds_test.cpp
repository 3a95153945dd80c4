// SPDX-License-Identifier: BSD-3-Clause
// Rawlogs as people really have them: clouds in files of their own, several lidars under one label.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <filesystem>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using namespace test;
namespace fs = std::filesystem;
using mrpt::obs::CObservationPointCloud;
using testing::ElementsAre;
using testing::HasSubstr;

/// A rawlog of three clouds of 1, 2 and 3 points, each in a file of its own.
class ExternalRawlog : public testing::Test {
  protected:
    /// @param before  the rawlog has it in front of the files' names.
    void write(const std::string& rawlog, const std::string& folder, const std::string& before = "") const {
        fs::create_directories(fs::path(file(rawlog)).parent_path());
        fs::create_directories(file(folder));
        Objects objects;
        for (int k = 1; k <= 3; ++k) {
            const auto scan = CObservationPointCloud::Create();
            scan->sensorLabel = "top";
            scan->timestamp = mrpt::Clock::fromDouble(1000.0 + k);
            const std::string name = "scan_" + std::to_string(k) + ".bin";
            mrpt::maps::CSimplePointsMap points;
            for (int p = 0; p < k; ++p) points.insertPoint(10.0F, static_cast<float>(p), 0.0F);
            writeRawlog(file(folder) + "/" + name, {std::make_shared<mrpt::maps::CSimplePointsMap>(points)}, true);
            scan->setAsExternalStorage(before + name,
                                       CObservationPointCloud::ExternalStorageFormat::MRPT_Serialization);
            objects.push_back(scan);
        }
        writeRawlog(file(rawlog), objects, true);
    }
    std::string file(const std::string& name) const { return folder_.file(name); }

    /// Points of each scan; -1: a gap.
    std::vector<int> points(const std::string& rawlog) {
        RawlogReader reader(rawlog);
        std::vector<int> counts;
        while (const auto item = reader.next())
            counts.push_back(item->is_gap ? -1 : static_cast<int>(toPointCloud(*item->observation, {})->size()));
        EXPECT_EQ(reader.status(), SourceStatus::End);
        remarks_ = reader.remarks();
        return counts;
    }

    std::string remarks_;

  private:
    TempFolder folder_;
};

TEST_F(ExternalRawlog, IsReadFromAnyWorkingDirectory) {
    write("logs/drive.rawlog", "logs/drive_Images");
    const fs::path before = fs::current_path();
    EXPECT_THAT(points(file("logs/drive.rawlog")), ElementsAre(1, 2, 3));
    for (const auto& [folder, rawlog] : {std::pair("logs", "drive.rawlog"), std::pair("", "logs/drive.rawlog"),
                                         std::pair("logs/drive_Images", "../drive.rawlog")}) {
        fs::current_path(file(folder));
        EXPECT_THAT(points(rawlog), ElementsAre(1, 2, 3)) << folder;
    }
    fs::current_path(before);
    EXPECT_EQ(remarks_, "");
}

TEST_F(ExternalRawlog, MayHaveItsFilesInAnyOfTheUsualFolders) {
    for (const char* folder : {"a/drive_images", "b/drive_IMAGES", "c/Images", "d"}) {
        const std::string rawlog = std::string(1, folder[0]) + "/drive.rawlog";
        write(rawlog, folder);
        EXPECT_THAT(points(file(rawlog)), ElementsAre(1, 2, 3)) << folder;
    }
    write("e/drive.rawlog.gz", "e/drive_Images");
    EXPECT_THAT(points(file("e/drive.rawlog.gz")), ElementsAre(1, 2, 3));
}

TEST_F(ExternalRawlog, IsReadThroughALinkFromElsewhere) {
    write("logs/drive.rawlog", "logs/drive_Images");
    fs::create_directories(file("mine"));
    fs::create_symlink(file("logs/drive.rawlog"), file("mine/today.rawlog"));
    EXPECT_THAT(points(file("mine/today.rawlog")), ElementsAre(1, 2, 3));
}

TEST_F(ExternalRawlog, MayHaveBeenMadeElsewhere) {
    write("a/drive.rawlog", "a/drive_Images", "/home/them/drive_Images/");
    EXPECT_THAT(points(file("a/drive.rawlog")), ElementsAre(1, 2, 3)) << "files have moved";
    write("b/drive.rawlog", "b/drive_Images", "C:\\logs\\drive_Images\\");
    EXPECT_THAT(points(file("b/drive.rawlog")), ElementsAre(1, 2, 3));
    write("c/drive.rawlog", "c/drive_Images", "lidar\\");
    EXPECT_THAT(points(file("c/drive.rawlog")), ElementsAre(1, 2, 3));
    write("d/drive.rawlog", "d/drive_Images/lidar", "lidar/");
    EXPECT_THAT(points(file("d/drive.rawlog")), ElementsAre(1, 2, 3));
}

TEST_F(ExternalRawlog, AMissingOrDamagedFileIsAGap) {
    write("drive.rawlog", "drive_Images");
    fs::remove(file("drive_Images/scan_2.bin"));
    EXPECT_THAT(points(file("drive.rawlog")), ElementsAre(1, -1, 3));
    EXPECT_THAT(remarks_, HasSubstr("1 scans left out whose points cannot be read"));
    EXPECT_THAT(remarks_, HasSubstr("scan_2.bin"));
    writeFile(file("drive_Images/scan_1.bin"), "no cloud at all");
    EXPECT_THAT(points(file("drive.rawlog")), ElementsAre(-1, -1, 3));
    EXPECT_THAT(remarks_, HasSubstr("2 scans left out"));
}

TEST_F(ExternalRawlog, ACopyHoldsThePointsItself) {
    write("drive.rawlog", "drive_Images");
    RawlogReader reader(file("drive.rawlog"));
    const auto item = reader.next();
    ASSERT_TRUE(item);
    writeRawlog(file("copy.rawlog"), {item->observation}, false);
    fs::remove_all(file("drive_Images"));
    EXPECT_THAT(points(file("copy.rawlog")), ElementsAre(1));
}

/// Names of the lidars of the scans.
std::vector<std::string> lidars(const Objects& objects) {
    const TempFolder folder;
    writeRawlog(folder.file("drive.rawlog"), objects, false);
    RawlogReader reader(folder.file("drive.rawlog"));
    std::vector<std::string> names;
    while (const auto item = reader.next()) names.push_back(item->lidar);
    return names;
}

std::shared_ptr<VelodyneScan> scanAt(const mrpt::poses::CPose3D& pose) {
    const auto scan = scanLabelled("");
    scan->sensorPose = pose;
    return scan;
}

TEST(LidarNames, LidarsOfOneLabelAreToldApartByTheirPlace) {
    const auto front = scanAt({1.5, 0, 1.8, 0, 0, 0}), rear = scanAt({-1.5, 0, 1.8, M_PI, 0, 0});
    EXPECT_THAT(lidars({front, rear, front, rear}), ElementsAre("", "#2", "", "#2"));
    const auto hanging = scanAt({1.5, 0, 1.8, 0, 0, M_PI});
    EXPECT_THAT(lidars({front, hanging, front}), ElementsAre("", "#2", "")) << "same place, upside down";
}

TEST(LidarNames, LidarsOfOneLabelAreToldApartByTheirClass) {
    const auto cloud = CObservationPointCloud::Create();
    cloud->sensorLabel = "lidar";
    EXPECT_THAT(lidars({scanLabelled("lidar"), cloud, scanLabelled("lidar")}),
                ElementsAre("lidar", "lidar#2", "lidar"));
}

TEST(LidarNames, ALidarThatIsTiltedSlowlyStaysTheSame) {
    Objects scans;
    for (int k = 0; k < 20; ++k) scans.push_back(scanAt({0, 0, 1, 0, 0.05 * k, 0}));
    EXPECT_THAT(lidars(scans), testing::Each(""));
}

}  // namespace
}  // namespace lidar_obstacles
