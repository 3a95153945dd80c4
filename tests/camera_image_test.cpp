// SPDX-License-Identifier: BSD-3-Clause
// Images of cameras: where boxes are in them, by numbers; which of them belongs to a scan.
#include "camera_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "camera_images.h"
#include "support/camera_recording.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::apps {
namespace {

using mrpt::img::DistortionModel;
using testing::ElementsAre;
using testing::HasSubstr;

/// 640 x 480, 90 degrees wide, 1.5 m above the ground, 2 m ahead; looks ahead.
CameraImage looksAhead() {
    CameraImage image;
    image.image.resize(640, 480, mrpt::img::CH_RGB);
    image.camera.setIntrinsicParamsFromValues(320.0, 320.0, 320.0, 240.0);
    image.T_vehicle_camera = test::aheadFrom({2.0, 0.0, 1.5});
    return image;
}

TEST(CameraProjection, APinholeCameraSeesAPointWhereTheRuleOfThreeSays) {
    const CameraProjection p(looksAhead());
    ASSERT_TRUE(p.isCalibrated());
    // 10 m ahead of the camera: 32 pixels a metre
    EXPECT_NEAR((*p.pixelOf({12, 0, 1.5}) - Eigen::Vector2d(320, 240)).norm(), 0.0, 1e-9);
    EXPECT_NEAR((*p.pixelOf({12, 2, 1.5}) - Eigen::Vector2d(320 - 64, 240)).norm(), 0.0, 1e-9) << "left is left";
    EXPECT_NEAR((*p.pixelOf({12, 0, 0.5}) - Eigen::Vector2d(320, 240 + 32)).norm(), 0.0, 1e-9) << "low is below";
    EXPECT_FALSE(p.pixelOf({2.05, 0, 1.5})) << "nearer than 0.1 m";
    EXPECT_FALSE(p.pixelOf({-5, 0, 1.5})) << "behind it";
}

TEST(CameraProjection, ALensBendsAsItsModelSays) {
    CameraImage image = looksAhead();
    image.camera.setDistortionPlumbBob(-0.1, 0.01, 0.0, 0.0, 0.0);
    const double r2 = 0.2 * 0.2, r = 0.2 * (1.0 - 0.1 * r2 + 0.01 * r2 * r2);
    EXPECT_NEAR(CameraProjection(image).pixelOf({12, 2, 1.5})->x(), 320.0 - 320.0 * r, 1e-6);
    EXPECT_FALSE(CameraProjection(image).pixelOf({3, 20, 1.5})) << "where the model does not hold";
    image.camera.setDistortionKannalaBrandt(0.02, 0.0, 0.0, 0.0);
    const double theta = std::atan(0.2);
    EXPECT_NEAR(CameraProjection(image).pixelOf({12, 2, 1.5})->x(), 320.0 - 320.0 * (theta + 0.02 * std::pow(theta, 3)),
                1e-6);
}

TEST(CameraProjection, ACalibrationOfAnotherSizeIsScaled) {
    CameraImage image = looksAhead();
    image.camera.ncols = 1280;
    image.camera.nrows = 960;
    image.camera.setIntrinsicParamsFromValues(640.0, 640.0, 640.0, 480.0);
    EXPECT_NEAR(CameraProjection(image).pixelOf({12, 2, 1.5})->x(), 320.0 - 64.0, 1.0);
    image.camera.ncols = 1242;  // no camera has scaled that to 640 x 480
    image.camera.nrows = 375;
    image.camera.setIntrinsicParamsFromValues(320.0, 320.0, 320.0, 240.0);
    EXPECT_NEAR(CameraProjection(image).pixelOf({12, 2, 1.5})->x(), 320.0 - 64.0, 1e-9) << "taken as it is";
    image.camera = {};
    EXPECT_FALSE(CameraProjection(image).isCalibrated());
    EXPECT_FALSE(CameraProjection(image).pixelOf({12, 0, 1.5}));
}

TEST(CameraProjection, TheEdgesOfABoxEnclose) {
    const CameraProjection p(looksAhead());
    OrientedBox box;
    box.center = {14, 1, 0.75};
    box.size = {4.0, 2.0, 1.5};
    Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
    for (const auto& [from, to] : p.edgesOf(box))
        for (const Eigen::Vector2d& end : {from, to}) {
            low = low.cwiseMin(end);
            high = high.cwiseMax(end);
        }
    // Its near face is 10 m ahead of the camera, from 0 to 2 m to the left, from the ground to the camera's height.
    EXPECT_NEAR(low.x(), 320 - 64, 1e-9);
    EXPECT_NEAR(high.x(), 320, 1e-9);
    EXPECT_NEAR(low.y(), 240, 1e-9);
    EXPECT_NEAR(high.y(), 240 + 48, 1e-9);
    box.center.x() = -10;
    EXPECT_TRUE(p.edgesOf(box).empty()) << "behind the camera";
    box.center = {14, 40, 0.75};
    EXPECT_TRUE(p.edgesOf(box).empty()) << "beside the image";
    box.center = {2, 5, 0.75};  // beside the camera: its front half is ahead of it
    EXPECT_TRUE(p.edgesOf(box).empty()) << "not yet in the image";
    box.center = {4.0, 1.5, 0.75};
    EXPECT_FALSE(p.edgesOf(box).empty()) << "its near end is beside the camera, its far end in the image";
}

class Recording : public testing::TestWithParam<bool> {
  protected:
    void open(const test::CameraRecording& what) {
        const std::string path = folder_.file("drive.rawlog");
        test::writeCameraRecording(path, what);
        store_.emplace(path, ScanSelection{{}, 0, 1000, 1});
        while (!store_->complete()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        EXPECT_EQ(store_->problem(), "");
    }
    test::TempFolder folder_;
    std::optional<ScanStore> store_;
};
INSTANTIATE_TEST_SUITE_P(PlainAndGzip, Recording, testing::Bool());

TEST_P(Recording, TheImageNearestInTimeBelongsToAScan) {
    test::CameraRecording what;
    what.compressed = GetParam();
    what.scans = 6;  // 0.1 s apart, images 0.02 s later, none beside the last three
    what.images = 3;
    open(what);
    EXPECT_THAT(store_->cameras(), ElementsAre("front", "rear"));
    CameraImages images;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto image = images.beside(*store_, k);
        ASSERT_TRUE(image);
        EXPECT_EQ(image->problem, "");
        EXPECT_EQ(image->label, "front");
        EXPECT_NEAR(image->time - store_->time(k), 0.02, 1e-3);
        EXPECT_EQ(image->image.getWidth(), 640U);
        EXPECT_TRUE(image->image.isColor());
        EXPECT_NEAR(image->T_vehicle_camera.translation().x(), 2.0, 1e-6);
        EXPECT_NEAR(CameraProjection(*image).pixelOf({12, 2, 1.5})->x(), 320.0 - 64.0, 1e-6);
    }
    EXPECT_EQ(images.next(*store_), "images of rear");
    EXPECT_EQ(images.beside(*store_, 0)->label, "rear");
    EXPECT_EQ(images.next(*store_), "no images");
    EXPECT_FALSE(images.beside(*store_, 0));
    EXPECT_EQ(images.next(*store_), "images of front");
    EXPECT_EQ(store_->imageBeside("front", 4), 2U) << "0.18 s are near";
    EXPECT_FALSE(store_->imageBeside("front", 5)) << "0.28 s are not";
    EXPECT_NO_THROW(store_->read(5)) << "scans are where they were";
}

TEST_P(Recording, ImagesMayBeInFilesOfTheirOwn) {
    test::CameraRecording what;
    what.compressed = GetParam();
    what.folder = folder_.file("drive_Images");
    open(what);
    EXPECT_EQ(store_->readImage("front", 1).problem, "");
    EXPECT_EQ(store_->readImage("front", 1).image.getHeight(), 480U);
    std::filesystem::remove(folder_.file("drive_Images/front_1.png"));
    EXPECT_THAT(store_->readImage("front", 1).problem, HasSubstr("front_1.png: no such file in "));
    test::writeFile(folder_.file("drive_Images/front_1.png"), "no image");
    EXPECT_THAT(store_->readImage("front", 1).problem, HasSubstr("front_1.png: no image in it"));
}

TEST(CameraImages, ARecordingWithoutCamerasSaysSo) {
    test::TempFolder folder;
    test::CameraRecording what;
    what.images = 0;
    test::writeCameraRecording(folder.file("drive.rawlog"), what);
    const ScanStore store(folder.file("drive.rawlog"), {{}, 0, 10, 1});
    store.waitFor(0);
    CameraImages images;
    EXPECT_FALSE(images.beside(store, 0));
    EXPECT_EQ(images.next(store), "no images of cameras in this recording");
}

}  // namespace
}  // namespace lidar_obstacles::apps
