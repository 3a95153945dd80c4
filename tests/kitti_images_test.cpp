// SPDX-License-Identifier: BSD-3-Clause
// kitti2rawlog --images: which image belongs to a scan, and where its camera is.
#include <gmock/gmock.h>
#include <mrpt/obs/CObservationImage.h>

#include <filesystem>

#include "support/kitti_recording.h"

namespace lidar_obstacles {
namespace {

using namespace test;
namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::SizeIs;

/// fx = 700, fy = 710, cx = 600, cy = 180; the camera is 0.06 m to the left of camera 0 and 0.01 m behind it.
constexpr const char* kProjection = "700 0 600 48 0 710 180 1.8 0 0 1 0.01\n";

class KittiImages : public Kitti2Rawlog {
  protected:
    using Images = std::vector<mrpt::obs::CObservationImage::Ptr>;
    Images images() const {
        Images all;
        const auto source = openScanSource(path("out.rawlog"));
        while (const auto item = source->next())
            if (auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(item->observation))
                all.push_back(std::move(image));
        return all;
    }
    /// 20 x 6 pixels.
    void writeImage(const std::string& name) const {
        fs::create_directories(fs::path(path(name)).parent_path());
        mrpt::img::CImage image(20, 6, mrpt::img::CH_RGB);
        image.filledRectangle(0, 0, 19, 5, mrpt::img::TColor(50, 100, static_cast<int>(name.size())));
        ASSERT_TRUE(image.saveToFile(path(name)));
    }
    /// The camera of calibration() with kProjection, and the copy of a file.
    void expectImage(const mrpt::obs::CObservationImage& image, const std::string& original) const {
        EXPECT_EQ(image.sensorLabel, "camera_2");
        EXPECT_EQ(image.cameraParams.fx(), 700.0);
        EXPECT_EQ(image.cameraParams.fy(), 710.0);
        EXPECT_EQ(image.cameraParams.cx(), 600.0);
        EXPECT_EQ(image.cameraParams.cy(), 180.0);
        // t = (42 / 700, 0, 0.01) in camera axes: 0.27 - 0.01 ahead of the velodyne, 0.06 to its left, 0.08 below
        EXPECT_NEAR(image.cameraPose.x(), 0.26, 1e-9);
        EXPECT_NEAR(image.cameraPose.y(), 0.06, 1e-9);
        EXPECT_NEAR(image.cameraPose.z(), kHeight - 0.08, 1e-9);
        const auto R = image.cameraPose.getRotationMatrix();
        EXPECT_NEAR(R(0, 2), 1.0, 1e-9) << "it looks ahead";
        EXPECT_NEAR(R(1, 0), -1.0, 1e-9) << "its x is right";
        ASSERT_TRUE(image.image.isExternallyStored());
        EXPECT_EQ(readFile(path("out_Images/" + image.image.getExternalStorageFile())), readFile(path(original)));
        EXPECT_EQ(image.cameraParams.ncols, 20U);
        EXPECT_EQ(image.cameraParams.nrows, 6U);
    }
    static std::string withProjection() { return calibration() + "P2: " + kProjection; }
};

TEST_F(KittiImages, OfObjectsAreFoundByTheirNumber) {
    for (const char* number : {"000003", "000007"}) {
        writePoints(std::string("in/velodyne/") + number + ".bin", turn(63, 0, 36));
        write(std::string("in/calib/") + number + ".txt", withProjection());
    }
    writeImage("in/image_2/000007.png");
    const Outcome r = run("--images");
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.err, HasSubstr("1 scans have no image"));
    ASSERT_THAT(images(), SizeIs(1));
    expectImage(*images()[0], "in/image_2/000007.png");
    EXPECT_THAT(contents().clouds, SizeIs(2));
}

TEST_F(KittiImages, AnImageThatCannotBeReadEndsTheConversionAndKeepsWhatCameBefore) {
    for (const char* number : {"000003", "000004"}) {
        writePoints(std::string("in/velodyne/") + number + ".bin", turn(63, 0, 36));
        write(std::string("in/calib/") + number + ".txt", withProjection());
    }
    writeImage("in/image_2/000003.png");
    write("in/image_2/000004.png", "no image");
    const Outcome r = run("--images");
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, HasSubstr("000004.png: no image in it; the scans before it are written"));
    EXPECT_THAT(contents().clouds, SizeIs(1));
    EXPECT_THAT(images(), SizeIs(1));
}

TEST_F(KittiImages, WithoutTheFlagThereAreNone) {
    writePoints("in/velodyne/000000.bin", turn(63, 0, 36));
    write("in/calib/000000.txt", withProjection());
    writeImage("in/image_2/000000.png");
    ASSERT_EQ(run("").code, 0);
    EXPECT_THAT(images(), SizeIs(0));
    EXPECT_FALSE(fs::exists(path("out_Images")));
}

TEST_F(KittiImages, OfTrackingAreFoundByTheirNumber) {
    for (const char* number : {"000000", "000002"})
        writePoints(std::string("in/velodyne/0004/") + number + ".bin", turn(63, 0, 36));
    for (const char* number : {"000000", "000001", "000002"})
        writeImage(std::string("in/image_02/0004/") + number + ".png");
    write("in/calib/0004.txt", withProjection());
    const Outcome r = run("--layout tracking --sequence 0004 --images");
    ASSERT_EQ(r.code, 0) << r.err;
    ASSERT_THAT(images(), SizeIs(2));
    expectImage(*images()[1], "in/image_02/0004/000002.png");
}

TEST_F(KittiImages, OfOdometryAreFoundByTheirNumber) {
    writePoints("in/sequences/07/velodyne/000001.bin", turn(63, 0, 36));
    write("in/sequences/07/times.txt", "0\n0.1\n");
    write("in/sequences/07/calib.txt", std::string("P2: ") + kProjection + "Tr: 0 -1 0 0 0 0 -1 -0.08 1 0 0 -0.27\n");
    writeImage("in/sequences/07/image_2/000001.png");
    const Outcome r = run("--sequence 07 --images");
    ASSERT_EQ(r.code, 0) << r.err;
    ASSERT_THAT(images(), SizeIs(1));
    expectImage(*images()[0], "in/sequences/07/image_2/000001.png");
}

TEST_F(KittiImages, OfRawDrivesHaveTimesOfTheirOwn) {
    const std::string drive = "in/2011_09_26/drive_0001_sync/";
    writePoints(drive + "velodyne_points/data/0000000000.bin", turn(63, 0, 36));
    write(drive + "velodyne_points/timestamps.txt", "2011-09-26 13:02:25.964389445\n");
    write("in/2011_09_26/calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 -0.08 -0.27\n");
    write("in/2011_09_26/calib_cam_to_cam.txt", std::string("R_rect_00: 1 0 0 0 1 0 0 0 1\nP_rect_02: ") + kProjection);
    writeImage(drive + "image_02/data/0000000000.png");
    write(drive + "image_02/timestamps.txt", "2011-09-26 13:02:25.951199337\n");
    const Outcome r = run("--images", drive);
    ASSERT_EQ(r.code, 0) << r.err;
    ASSERT_THAT(images(), SizeIs(1));
    expectImage(*images()[0], drive + "image_02/data/0000000000.png");
    EXPECT_NEAR(mrpt::Clock::toDouble(images()[0]->timestamp), 1317042145.951199, 1e-5);
}

TEST_F(KittiImages, WhatIsMissingIsNamedAndNoCopyIsLeftBehind) {
    writePoints("in/velodyne/000000.bin", turn(63, 0, 36));
    write("in/calib/000000.txt", calibration());
    EXPECT_THAT(run("--images").err, HasSubstr("image_2: no such folder: --images needs it"));
    writeImage("in/image_2/000000.png");
    EXPECT_THAT(run("--images").err, HasSubstr("000000.txt: no P2 in it"));
    write("in/calib/000000.txt", withProjection());
    write("in/image_2/000000.png", "no image");
    EXPECT_THAT(run("--images").err, HasSubstr("000000.png: no image in it"));
    EXPECT_FALSE(fs::exists(path("out_Images")));
    writeImage("in/image_2/000000.png");
    write("out_Images", "a file in the way");
    EXPECT_THAT(run("--images").err, HasSubstr("000000.png: cannot copy to "));
    EXPECT_FALSE(fs::exists(path("out.rawlog")));
}

}  // namespace
}  // namespace lidar_obstacles
