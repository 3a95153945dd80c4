// SPDX-License-Identifier: BSD-3-Clause
// kitti2rawlog where the number of a line is that of a scan, and scans, times or poses are missing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/kitti_recording.h"

namespace lidar_obstacles {
namespace {

using namespace test;
namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kStart = 1317042145.0;  // 2011-09-26 13:02:25 UTC

/// Scan n of a drive was measured 25.05 s + n / 10 after the minute, its pose 0.05 s before, n metres further north.
class KittiRows : public Kitti2Rawlog {
  protected:
    const std::string drive_ = "in/2011_09_26/drive_0009_sync/";

    static std::string name(int number) { return std::string(9, '0') + std::to_string(number); }
    static std::string timeLine(double seconds) {
        return "2011-09-26 13:02:" + std::to_string(seconds) + "000\n";  // as KITTI: nanoseconds
    }
    void writeScan(int n) const { writePoints(drive_ + "velodyne_points/data/" + name(n) + ".bin", turn(63, 60, 36)); }
    void writePose(int row, double metres_north) const {
        write(drive_ + "oxts/data/" + name(row) + ".txt",
              std::to_string(49.0 + metres_north / 111319.5) + " 8.4 112 0 0 0 0 0\n");
    }
    /// Ten frames of which the lidar lacks 4 and 5.
    void writeDrive() const {
        std::string times;
        for (int n = 0; n < 10; ++n) {
            writePose(n, 100.0 * n);
            const bool missing = n == 4 || n == 5;
            if (!missing) writeScan(n);
            times += missing ? "\n" : timeLine(25.05 + 0.1 * n);
        }
        write(drive_ + "velodyne_points/timestamps.txt", times);
        write("in/2011_09_26/calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n");
    }
};

TEST_F(KittiRows, AnEmptyLineOfTimesStandsForAMissingScan) {
    writeDrive();
    const Outcome r = run("", drive_);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("2 scans between the others are missing, the first is 4"));
    const Contents c = contents();
    ASSERT_EQ(c.clouds.size(), 8U);
    ASSERT_EQ(c.poses.size(), 8U);
    const std::vector<int> numbers = {0, 1, 2, 3, 6, 7, 8, 9};
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        EXPECT_NEAR(c.clouds[k].timestamp, kStart + 0.05 + 0.1 * numbers[k], 1e-5) << numbers[k];
        EXPECT_NEAR(c.poses[k]->pose.mean.y(), 100.0 * numbers[k], 1.0);
    }
}

TEST_F(KittiRows, AsManyTimesAsScansBelongToTheseInTheirOrder) {
    writeDrive();
    std::string times;  // the lines of scans 4 and 5 are not empty, but gone
    for (const int n : {0, 1, 2, 3, 6, 7, 8, 9}) times += timeLine(25.05 + 0.1 * n);
    write(drive_ + "velodyne_points/timestamps.txt", times);
    const Outcome r = run("", drive_);
    ASSERT_EQ(r.code, 0) << r.err;
    const Contents c = contents();
    ASSERT_EQ(c.clouds.size(), 8U);
    EXPECT_NEAR(c.clouds[4].timestamp, kStart + 0.65, 1e-5);
    EXPECT_NEAR(c.clouds[7].timestamp, kStart + 0.95, 1e-5);
}

TEST_F(KittiRows, AScanWithoutTimeEndsTheConversionAndKeepsWhatCameBefore) {
    writeDrive();
    writeScan(4);
    Outcome r = run("", drive_);
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, HasSubstr("timestamps.txt:5: no time for"));
    EXPECT_EQ(contents().clouds.size(), 4U);

    write(drive_ + "velodyne_points/timestamps.txt", timeLine(25.05) + timeLine(25.15));
    r = run("", drive_);
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, HasSubstr("timestamps.txt has 2 lines only"));
    EXPECT_EQ(contents().clouds.size(), 2U);
}

TEST_F(KittiRows, AScanWithoutPoseIsAGapOfThePoses) {
    writeDrive();
    fs::remove(path(drive_ + "oxts/data/" + name(0) + ".txt"));
    write(drive_ + "oxts/data/" + name(7) + ".txt", "\n");
    const Outcome r = run("", drive_);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("2 scans have no pose"));
    const Contents c = contents();
    EXPECT_EQ(c.clouds.size(), 8U);
    EXPECT_EQ(c.poses.size(), 6U);
}

TEST_F(KittiRows, PosesThatAreCountedApartFromTheScansAreFoundByTheirTimes) {
    writeDrive();
    std::string times;  // every 0.01 s, from 0.05 s before the first scan on
    for (int row = 0; row < 100; ++row) {
        times += timeLine(25.0 + 0.01 * row);
        writePose(row, 100.0 * row);
    }
    for (int row = 10; row < 100; ++row)
        fs::rename(path(drive_ + "oxts/data/" + name(row) + ".txt"),
                   path(drive_ + "oxts/data/" + std::string(8, '0') + std::to_string(row) + ".txt"));
    write(drive_ + "oxts/timestamps.txt", times);
    ASSERT_EQ(run("", drive_).code, 0);
    const Contents c = contents();
    ASSERT_EQ(c.poses.size(), 8U);
    // The first pose, 0.05 s before the first scan, is near enough to be that of its number; then they run apart.
    EXPECT_NEAR(c.poses[7]->pose.mean.y(), 9500.0, 10.0) << "25.95 s";
}

TEST_F(KittiRows, AnEmptyRowOfATrackingSequenceIsAGapOfThePoses) {
    for (const char* scan : {"000000", "000002"})
        writePoints(std::string("in/velodyne/0004/") + scan + ".bin", turn(63, 60, 36));
    write("in/label_02/0004.txt", "");
    write("in/calib/0004.txt", calibration());
    write("in/oxts/0004.txt", "49 8.4 112 0 0 0\n\n49.001 8.4 112 0 0 0\n");
    const Outcome r = run("--sequence 0004");
    ASSERT_EQ(r.code, 0) << r.err;
    const Contents c = contents();
    ASSERT_EQ(c.poses.size(), 2U);
    EXPECT_NEAR(c.poses[1]->pose.mean.y(), 111.3, 0.5) << "the third row";
}

TEST_F(KittiRows, NumbersWithoutZerosInFrontAreNumbers) {
    writeDrive();
    std::string times;
    for (int n = 0; n < 12; ++n) times += timeLine(25.05 + 0.1 * n);
    write(drive_ + "velodyne_points/timestamps.txt", times);
    const fs::path folder = path(drive_ + "velodyne_points/data");
    fs::remove_all(folder);
    fs::remove_all(path(drive_ + "oxts"));
    for (const int n : {2, 9, 10, 11})
        writePoints(drive_ + "velodyne_points/data/" + std::to_string(n) + ".bin", turn(63, 60, 36));
    ASSERT_EQ(run("", drive_).code, 0);
    const Contents c = contents();
    ASSERT_EQ(c.clouds.size(), 4U);
    EXPECT_NEAR(c.clouds[1].timestamp, kStart + 0.95, 1e-5);
    EXPECT_NEAR(c.clouds[3].timestamp, kStart + 1.15, 1e-5);
}

/// An odometry sequence: scan n at 0.11 s * n; the camera moves n metres along its z axis, which looks ahead.
class KittiOdometry : public KittiRows {
  protected:
    void writeSequence(const std::string& folder, const std::string& poses) const {
        std::string times, rows;
        for (int n = 0; n < 4; ++n) {
            if (n != 2) writePoints(folder + "velodyne/00000" + std::to_string(n) + ".bin", turn(63, 60, 36));
            times += n == 2 ? "\n" : std::to_string(0.11 * n) + "\n";
            rows += n == 2 ? "\n" : "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(n) + "\n";
        }
        write(folder + "times.txt", times);
        write(folder + "calib.txt", "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 -0.08 1 0 0 -0.27\n");
        write(poses, rows);
    }
    void expectSequence() const {
        const Contents c = contents();
        ASSERT_EQ(c.clouds.size(), 3U);
        ASSERT_EQ(c.poses.size(), 3U);
        EXPECT_NEAR(c.clouds[2].timestamp, 1000.33, 1e-5);
        EXPECT_NEAR(c.poses[2]->pose.mean.x(), 3.0, 1e-6) << "the camera's z is the vehicle's x";
        EXPECT_NEAR(c.poses[2]->pose.mean.y(), 0.0, 1e-6);
        EXPECT_NEAR(c.poses[2]->pose.mean.z(), 0.0, 1e-6);
    }
};

TEST_F(KittiOdometry, HasTheTimesAndPosesOfItsRows) {
    writeSequence("in/sequences/07/", "in/poses/07.txt");
    Outcome r = run("--sequence 07 --start-time 1000");
    ASSERT_EQ(r.code, 0) << r.err;
    expectSequence();
    r = run("--start-time 1000", "in/sequences/07");
    ASSERT_EQ(r.code, 0) << r.err;
    expectSequence();
    EXPECT_THAT(run("").err, HasSubstr("which sequence?"));
}

TEST_F(KittiOdometry, MayHaveItsPosesBesideTheScans) {
    writeSequence("in/", "in/poses.txt");
    const Outcome r = run("--start-time 1000");
    ASSERT_EQ(r.code, 0) << r.err;
    expectSequence();
    write("in/poses.txt", "1 0 0\n");
    EXPECT_THAT(run("").err, HasSubstr("poses.txt:1: 3 numbers, expected 12"));
}

}  // namespace
}  // namespace lidar_obstacles
