// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay --gui on a recording with images of a camera: a street in which the labelled objects were painted.
#include <mrpt/io/CFileGZInputStream.h>

#include "lidar_obstacles/evaluation/truth.h"
#include "support/camera_recording.h"
#include "support/window_fixture.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::waitUntil;
using namespace std::chrono_literals;

/// The pixel of a point of the vehicle frame by the rule of three: see cameraObservation().
mrpt::img::TPixelCoord pixelOf(const Eigen::Vector3d& p) {
    const double ahead = std::max(0.2, p.x() - 2.0);
    return {static_cast<int>(320 - 320 * p.y() / ahead), static_cast<int>(240 - 320 * (p.z() - 1.5) / ahead)};
}

/// Paints the objects as filled shapes, the far ones first.
void paint(std::vector<evaluation::TruthObject> objects, mrpt::img::CImage& image) {
    std::sort(objects.begin(), objects.end(),
              [](const auto& a, const auto& b) { return a.box.center.x() > b.box.center.x(); });
    for (const auto& o : objects) {
        if (o.box.center.x() < 4.0 || o.num_points == 0) continue;
        mrpt::img::TPixelCoord low{10000, 10000}, high{-10000, -10000};
        for (int k = 0; k < 8; ++k) {
            const Eigen::Vector3d half = 0.5 * o.box.size;
            const Eigen::Vector3d corner((k & 1) ? half.x() : -half.x(), (k & 2) ? half.y() : -half.y(),
                                         (k & 4) ? half.z() : -half.z());
            const Eigen::Vector3d at = o.box.center + Eigen::AngleAxisd(o.box.yaw, Eigen::Vector3d::UnitZ()) * corner;
            const auto pixel = pixelOf(at);
            low = {std::min(low.x, pixel.x), std::min(low.y, pixel.y)};
            high = {std::max(high.x, pixel.x), std::max(high.y, pixel.y)};
        }
        const bool is_vehicle = o.group == evaluation::Group::Vehicle;
        image.filledRectangle(std::clamp(low.x, 0, 639), std::clamp(low.y, 0, 479), std::clamp(high.x, 0, 639),
                              std::clamp(high.y, 0, 479),
                              is_vehicle ? mrpt::img::TColor(60, 70, 130) : mrpt::img::TColor(140, 60, 60));
    }
}

class WindowCamera : public test::WindowTest {
  protected:
    /// The street with an image beside each scan.
    /// @param wide  only the rows about the horizon: more than three times as wide as high.
    void writeStreet(const std::string& path, bool wide = false) {
        const auto truth = evaluation::readTruth(STREET_SAMPLE "_gt.csv", evaluation::TruthPose::Observed);
        mrpt::io::CFileGZInputStream in(STREET_SAMPLE ".rawlog");
        auto archive = mrpt::serialization::archiveFrom(in);
        test::Objects objects;
        for (int scan = 0; !in.checkEOF();) {
            mrpt::serialization::CSerializable::Ptr object;
            try {
                object = archive.ReadObject();
            } catch (const std::exception&) {
                break;  // the end
            }
            objects.push_back(object);
            const auto* lidar = dynamic_cast<const mrpt::obs::CObservationVelodyneScan*>(object.get());
            if (!lidar) continue;
            const auto image = test::cameraObservation("front", mrpt::Clock::toDouble(lidar->timestamp) + 0.05);
            std::vector<evaluation::TruthObject> here;
            for (const auto& o : truth)
                if (o.scan_index == scan) here.push_back(o);
            paint(here, image->image);
            if (wide) {
                const auto rows = image->image.makeDeepCopy();
                rows.extract_patch(image->image, 0, 140, 640, 190);
                image->cameraParams.cy(240.0 - 140.0);
            }
            objects.push_back(image);
            ++scan;
        }
        test::writeRawlog(path, objects, true);
    }
    void quit() {
        press("q");
        EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
    }
};

TEST_F(WindowCamera, TheImageOfTheScanIsShownWithTheBoxesInIt) {
    writeStreet(folder_.file("camera.rawlog"));
    ASSERT_NO_FATAL_FAILURE(openFile("camera.rawlog", "--size 1200x800"));
    ASSERT_TRUE(waitUntil([&] { return state().contains("image") && !state()["image"]["boxes"].empty(); }, 20s));
    const json first = state();
    EXPECT_EQ(first["image"]["camera"], "front");
    EXPECT_EQ(first["image"]["problem"], "");
    EXPECT_GE(3 * first["scene"][2].get<double>() * first["scene"][3].get<double>(), 2.0 * 1200 * 800 - 1200);
    // Each box is where its centre is in the image, by the rule of three.
    const json at = first["image"]["at"];
    const double scale = at[2].get<double>() / 640.0;
    EXPECT_NEAR(at[3].get<double>(), 480 * scale, 1.0) << "nothing is stretched";
    std::size_t checked = 0;
    for (std::size_t k = 0; k < first["boxes"].size(); ++k)
        for (const json& box : first["image"]["boxes"]) {
            if (box[0] != first["ids"][k]) continue;
            const json& b = first["boxes"][k];
            const double ahead = b[1].get<double>() - 2.0;
            EXPECT_NEAR(box[1].get<double>(), at[0].get<double>() + scale * (320.5 - 320 * b[2].get<double>() / ahead),
                        1.0);
            EXPECT_NEAR(box[2].get<double>(),
                        at[1].get<double>() + scale * (240.5 - 320 * (b[3].get<double>() - 1.5) / ahead), 1.0);
            ++checked;
        }
    EXPECT_GE(checked, 4U);
    for (const json& box : first["box_at"])
        if (box[0] == 0) click(box[1], box[2]);  // the car on the right, the first track
    ASSERT_TRUE(waitUntil([&] { return !state()["numbers"].empty(); }, 20s));
    EXPECT_EQ(state()["image"]["at"], at) << "panels are below it";
    press("Right");
    EXPECT_TRUE(shows("scan", 1));
    EXPECT_TRUE(waitUntil([&] { return state()["image"]["time"] != first["image"]["time"]; }, 20s));
    press("9");
    EXPECT_TRUE(waitUntil([&] { return !state().contains("image"); }, 20s));
    EXPECT_TRUE(shows("message", "no images"));
    quit();
}

TEST_F(WindowCamera, AWideImageStandsBelowTheScene) {
    writeStreet(folder_.file("camera.rawlog"), true);
    ASSERT_NO_FATAL_FAILURE(openFile("camera.rawlog", "--size 1200x800"));
    ASSERT_TRUE(waitUntil([&] { return state().contains("image") && !state()["image"]["boxes"].empty(); }, 20s));
    const json now = state();
    const json at = now["image"]["at"], scene = now["scene"];
    EXPECT_EQ(scene[2], 1200);
    EXPECT_GE(at[1].get<double>(), scene[3].get<double>());
    EXPECT_NEAR(at[2].get<double>() / at[3].get<double>(), 640.0 / 190.0, 0.02);
    EXPECT_GE(3 * scene[2].get<double>() * scene[3].get<double>(), 2.0 * 1200 * 800 - 1200);
    takePicture("window_camera.png");
    press("4");
    EXPECT_TRUE(waitUntil([&] { return state()["image"]["at"][1].get<double>() < 200.0; }, 20s)) << "above the table";
    quit();
}

TEST_F(WindowCamera, TheSceneKeepsTwoThirdsWithImageAndPanels) {
    writeStreet(folder_.file("camera.rawlog"));
    ASSERT_NO_FATAL_FAILURE(openFile("camera.rawlog", "--size 640x480"));
    press("4 p");
    ASSERT_TRUE(waitUntil([&] { return state()["rows"].size() > 5 && state().contains("image"); }, 20s));
    const json now = state();
    EXPECT_GE(3 * now["scene"][2].get<double>() * now["scene"][3].get<double>(), 2.0 * 640 * 480);
    EXPECT_GT(now["image"]["at"][3].get<double>(), 60.0);
    quit();
}

TEST_F(WindowCamera, WithoutCamerasAKeySaysSo) {
    ASSERT_NO_FATAL_FAILURE(open());
    press("9");
    EXPECT_TRUE(shows("message", "no images of cameras in this recording"));
    EXPECT_FALSE(state().contains("image"));
    quit();
}

}  // namespace
}  // namespace lidar_obstacles
