// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/scene.h"

#include <gtest/gtest.h>
#include <mrpt/opengl/CArrow.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CText.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "lidar_obstacles/detector.h"

namespace lidar_obstacles {
namespace {

using mrpt::opengl::CBox;
using mrpt::opengl::CPointCloudColoured;
using mrpt::opengl::CText;

/// Six returns: two of the ground, two of the car, one of something that was sorted out, one high above.
struct Example {
    PointCloud cloud;
    DetectionResult result;

    Example() {
        cloud.xyz = {{5.F, 0.F, 0.F},   {6.F, 1.F, 0.F},  {8.F, 3.F, 0.7F},
                     {8.F, 3.5F, 0.7F}, {4.F, -4.F, 1.F}, {9.F, 9.F, 6.F}};
        result.ground.evidence = GroundEvidence::Good;
        result.ground.is_ground = {1, 1, 0, 0, 0, 0};
        result.ground.height = {0.F, 0.F, 0.7F, 0.7F, 1.F, 6.F};
        result.candidates = {2, 3, 4};
        result.grid.origin = {-10.0, -10.0};
        result.grid.resolution = 0.5;
        result.grid.width = 40;
        result.grid.height = 40;
        result.grid.occupied = {26 * 40 + 36};
        Obstacle car;
        car.id = 4;
        car.cls = ObstacleClass::Vehicle;
        car.box = {{8.0, 3.0, 0.75}, {4.0, 1.8, 1.5}, 0.5};
        car.heading_valid = true;
        car.points = {2, 3};
        Obstacle person;
        person.id = 7;
        person.cls = ObstacleClass::Pedestrian;
        person.box = {{3.0, 0.0, 0.9}, {0.6, 0.6, 1.8}, 0.0};
        result.obstacles = {car, person};
        RejectedCluster rejected;
        rejected.cluster.points = {4};
        rejected.cluster.top = 1.F;
        rejected.reason = RejectReason::TooSmall;
        result.clusters.rejected.push_back(rejected);
    }
};

template <class T>
std::shared_ptr<T> find(mrpt::opengl::COpenGLScene& scene, const std::string& name) {
    return std::dynamic_pointer_cast<T>(scene.getByName(name));
}

std::size_t pointsIn(mrpt::opengl::COpenGLScene& scene, const std::string& name) {
    const auto cloud = find<CPointCloudColoured>(scene, name);
    return cloud ? cloud->size() : 0;
}

TEST(Scene, StructureThatIsNotFollowedHasNoNumberInItsLabel) {
    Example e;
    Obstacle& wall = e.result.obstacles.front();
    wall.cls = ObstacleClass::Structure;
    wall.id = kFirstUntrackedId + 3;
    const auto label = find<CText>(*toScene(e.cloud, e.result), "label_1000000003")->getString();
    EXPECT_EQ(label, "structure, 6.5 m");
}

TEST(Scene, EveryReturnIsInOneCloud) {
    const Example e;
    const auto scene = toScene(e.cloud, e.result);
    EXPECT_EQ(pointsIn(*scene, "ground"), 2U);
    EXPECT_EQ(pointsIn(*scene, "clustered"), 2U);
    EXPECT_EQ(pointsIn(*scene, "candidates"), 1U);
    EXPECT_EQ(pointsIn(*scene, "other"), 1U);
    EXPECT_EQ(pointsIn(*scene, "rejected"), 0U);
    SceneOptions options;
    options.rejected = true;
    const auto with_rejected = toScene(e.cloud, e.result, options);
    EXPECT_EQ(pointsIn(*with_rejected, "rejected"), 1U);
    EXPECT_EQ(pointsIn(*with_rejected, "candidates"), 0U);
}

TEST(Scene, ABoxStandsWhereTheObstacleIs) {
    const Example e;
    const auto scene = toScene(e.cloud, e.result);
    const auto box = find<CBox>(*scene, "box_4");
    ASSERT_TRUE(box);
    EXPECT_NEAR(box->getPose().x, 8.0, 1e-6);
    EXPECT_NEAR(box->getPose().y, 3.0, 1e-6);
    EXPECT_NEAR(box->getPose().z, 0.75, 1e-6);
    EXPECT_NEAR(box->getPose().yaw, 0.5, 1e-6);
    mrpt::math::TPoint3D low;
    mrpt::math::TPoint3D high;
    box->getBoxCorners(low, high);
    EXPECT_NEAR(high.x - low.x, 4.0, 1e-6);
    EXPECT_NEAR(high.y - low.y, 1.8, 1e-6);
    EXPECT_NEAR(high.z - low.z, 1.5, 1e-6);
    EXPECT_TRUE(box->isWireframe());
}

TEST(Scene, ClassesHaveColoursOfTheirOwn) {
    const Example e;
    const auto scene = toScene(e.cloud, e.result);
    const auto car = find<CBox>(*scene, "box_4")->getBoxBorderColor();
    const auto person = find<CBox>(*scene, "box_7")->getBoxBorderColor();
    EXPECT_FALSE(car.R == person.R && car.G == person.G && car.B == person.B);
}

TEST(Scene, OnlyAValidHeadingHasAnArrow) {
    const Example e;
    const auto scene = toScene(e.cloud, e.result);
    EXPECT_TRUE(scene->getByName("heading_4"));
    EXPECT_FALSE(scene->getByName("heading_7"));
}

TEST(Scene, ALabelTellsClassNumberAndDistance) {
    const Example e;
    const auto label = find<CText>(*toScene(e.cloud, e.result), "label_7");
    ASSERT_TRUE(label);
    EXPECT_EQ(label->getString(), "pedestrian 7, 2.7 m");  // 3.0 - 0.6 / 2
    SceneOptions options;
    options.labels = false;
    EXPECT_FALSE(toScene(e.cloud, e.result, options)->getByName("label_7"));
}

TEST(Scene, OfATrackTheLabelTellsSpeedAndAgeAndAnArrowWhereItGoes) {
    Example e;
    TrackState& t = e.result.obstacles[0].track.emplace();
    const auto label = [&] { return find<CText>(*toScene(e.cloud, e.result), "label_4")->getString(); };
    EXPECT_EQ(label(), "vehicle 4, 6.5 m, new");
    t.age = 2.25;
    t.velocity = Eigen::Vector2d(3.0, 4.0);
    EXPECT_EQ(label(), "vehicle 4, 6.5 m, stands, 2.2 s");
    EXPECT_FALSE(toScene(e.cloud, e.result)->getByName("speed_4"));
    t.moving = true;
    EXPECT_EQ(label(), "vehicle 4, 6.5 m, 5.0 m/s, 2.2 s");
    const auto arrow = find<mrpt::opengl::CSetOfTriangles>(*toScene(e.cloud, e.result), "speed_4");
    ASSERT_TRUE(arrow);
    mrpt::opengl::TTriangle head;
    arrow->getTriangle(2, head);
    EXPECT_NEAR(head.x(1), 8.0 + 3.0, 1e-5) << "where it will be in a second";
    EXPECT_NEAR(head.y(1), 3.0 + 4.0, 1e-5);
    t.seen = false;
    EXPECT_EQ(label(), "vehicle 4, 6.5 m, 5.0 m/s, hidden, 2.2 s");
}

TEST(Scene, AnEmptyResultGivesTheMarkerOnly) {
    const auto scene = toScene(PointCloud{}, DetectionResult{});
    EXPECT_TRUE(scene->getByName("ego"));
    EXPECT_TRUE(scene->getByName("range_rings"));
    EXPECT_FALSE(scene->getByName("grid"));
    EXPECT_EQ(pointsIn(*scene, "other"), 0U);
}

TEST(Scene, TheOwnBodyIsDrawnWithItsEdges) {
    const Example e;
    EXPECT_FALSE(toScene(e.cloud, e.result)->getByName("own_body"));
    SceneOptions options;
    options.own_body = OwnBody("box(-1, 2, -0.9, 0.9, 0.2, 1.4) polygon(2 0, 3 0, 2 1)");
    const auto lines = find<mrpt::opengl::CSetOfLines>(*toScene(e.cloud, e.result, options), "own_body");
    ASSERT_TRUE(lines);
    EXPECT_EQ(lines->size(), 3U * 4U + 3U * 3U);
    const auto box = lines->getBoundingBox();
    EXPECT_NEAR(box.min.x, -1.0, 1e-6);
    EXPECT_NEAR(box.max.x, 3.0, 1e-6);
    EXPECT_NEAR(box.max.y, 1.0, 1e-6);
}

TEST(Scene, TheRegionIsDrawnWhereItIsNoWholeRectangle) {
    const Example e;
    EXPECT_FALSE(toScene(e.cloud, e.result)->getByName("region"));
    SceneOptions options;
    options.region.outline = "polygon(0 0, 1 0, 0 1)";
    options.region.excluded = "box(4, 5, 0, 1) sector(0, 90)";
    const auto scene = toScene(e.cloud, e.result, options);
    EXPECT_EQ(find<mrpt::opengl::CSetOfLines>(*scene, "region")->getBoundingBox().max.x, 1.0);
    const auto excluded = find<mrpt::opengl::CSetOfLines>(*scene, "excluded")->getBoundingBox();
    EXPECT_NEAR(excluded.max.x, options.region.front, 1e-6) << "a sector ends on the rectangle";
    EXPECT_NEAR(excluded.max.y, options.region.lateral, 1e-6);
    EXPECT_NEAR(excluded.min.x, 0.0, 1e-6);
}

TEST(Scene, AResultOfAnotherCloudIsRefused) {
    Example e;
    e.cloud.xyz.pop_back();
    EXPECT_THROW(toScene(e.cloud, e.result), std::invalid_argument);
}

TEST(Scene, ASavedSceneLoadsWithItsNames) {
    const Example e;
    const auto file = std::filesystem::temp_directory_path() / "lidar_obstacles_scene_test.3Dscene";
    ASSERT_TRUE(toScene(e.cloud, e.result)->saveToFile(file.string()));
    mrpt::opengl::COpenGLScene loaded;
    ASSERT_TRUE(loaded.loadFromFile(file.string()));
    for (const char* name : {"grid", "ground", "clustered", "box_4", "heading_4", "label_4", "ego"}) {
        EXPECT_TRUE(loaded.getByName(name)) << name;
    }
    std::filesystem::remove(file);
}

TEST(Scene, DistanceIsToTheNearestPointOfTheBox) {
    EXPECT_NEAR(distanceTo({{10, 0, 0}, {4, 2, 1}, 0.0}), 8.0, 1e-9);
    EXPECT_NEAR(distanceTo({{10, 0, 0}, {4, 2, 1}, M_PI / 2}), 9.0, 1e-9);
    EXPECT_NEAR(distanceTo({{5, 5, 0}, {4, 4, 1}, 0.0}), std::hypot(3.0, 3.0), 1e-9);
    EXPECT_NEAR(distanceTo({{5, 5, 0}, {4, 2, 1}, M_PI / 4}), std::hypot(5.0, 5.0) - 2.0, 1e-9);
    EXPECT_EQ(distanceTo({{0.5, 0, 0}, {4, 2, 1}, 0.3}), 0.0);
}

/// Number of pixels that are near the colour.
int pixelsOf(const mrpt::img::CImage& picture, int red, int green, int blue) {
    int count = 0;
    for (unsigned y = 0; y < picture.getHeight(); ++y) {
        const auto* p = picture.ptrLine<std::uint8_t>(y);  // blue, green, red
        for (unsigned x = 0; x < picture.getWidth(); ++x, p += 3) {
            count += std::abs(p[0] - blue) < 40 && std::abs(p[1] - green) < 40 && std::abs(p[2] - red) < 40;
        }
    }
    return count;
}

TEST(SceneRenderer, APictureShowsTheBoxesInTheirColours) {
    const Example e;
    SceneOptions options;
    options.labels = false;
    SceneRenderer renderer(320, 240);
    CameraView view;
    view.distance = 15.0;
    const auto scene = toScene(e.cloud, e.result, options);
    const auto picture = renderer.render(*scene, view);
    ASSERT_EQ(picture.getWidth(), 320U);
    ASSERT_EQ(picture.getHeight(), 240U);
    EXPECT_GT(pixelsOf(picture, 255, 140, 0), 50);
    EXPECT_GT(pixelsOf(picture, 0, 255, 255), 10);
}

/// Number of pixels that differ.
int differingPixels(const mrpt::img::CImage& a, const mrpt::img::CImage& b) {
    int count = 0;
    for (unsigned y = 0; y < a.getHeight(); ++y) {
        const auto* p = a.ptrLine<std::uint8_t>(y);
        const auto* q = b.ptrLine<std::uint8_t>(y);
        for (unsigned x = 0; x < a.getWidth(); ++x, p += 3, q += 3) count += !std::equal(p, p + 3, q);
    }
    return count;
}

TEST(SceneRenderer, ASavedSceneLooksAsItDidWithItsGrid) {
    Example e;
    OccupancyGrid& grid = e.result.grid;
    for (std::int32_t row = 10; row < 30; ++row) {
        for (std::int32_t col = 14; col < 38; ++col)
            (row == 20 ? grid.occupied : grid.free).push_back(row * grid.width + col);
    }
    std::sort(grid.occupied.begin(), grid.occupied.end());
    const CameraView view{{4, 0, 0}, 30.0, 180.0, 60.0};
    const auto scene = toScene(e.cloud, e.result);
    const auto file = std::filesystem::temp_directory_path() / "lidar_obstacles_scene_grid_test.3Dscene";
    ASSERT_TRUE(scene->saveToFile(file.string()));
    mrpt::opengl::COpenGLScene loaded;
    ASSERT_TRUE(loaded.loadFromFile(file.string()));
    std::filesystem::remove(file);
    const auto before = SceneRenderer(400, 300).render(*scene, view);
    const auto after = SceneRenderer(400, 300).render(loaded, view);
    for (const auto& picture : {before, after}) {
        EXPECT_GT(pixelsOf(picture, 150, 36, 36), 300) << "occupied";
        EXPECT_GT(pixelsOf(picture, 40, 66, 46), 6000) << "free";
    }
    EXPECT_EQ(differingPixels(before, after), 0);
}

TEST(SceneRenderer, LeftIsLeftInAPictureFromBehind) {
    Example e;
    e.result.obstacles.resize(1);  // the car, 3 m to the left
    e.result.obstacles[0].heading_valid = false;
    SceneOptions options;
    options.labels = false;
    const auto scene = toScene(e.cloud, e.result, options);
    const auto picture = SceneRenderer(320, 240).render(*scene);
    int left = 0;
    int right = 0;
    for (unsigned y = 0; y < 240; ++y) {
        const auto* p = picture.ptrLine<std::uint8_t>(y);
        for (unsigned x = 0; x < 320; ++x, p += 3) {
            if (p[2] > 200 && p[1] > 100 && p[1] < 180 && p[0] < 40) ++(x < 160 ? left : right);
        }
    }
    EXPECT_GT(left, 20);
    EXPECT_EQ(right, 0);
}

TEST(SceneRenderer, OneRendererTakesPicturesOfManyScenes) {
    const Example e;
    SceneRenderer renderer(160, 120);
    for (int k = 0; k < 5; ++k) {
        const auto scene = toScene(e.cloud, e.result);
        EXPECT_GT(pixelsOf(renderer.render(*scene), 255, 140, 0), 5) << k;
    }
}

TEST(SceneRenderer, APictureOfAnyWidthIsTheLeftPartOfAWiderOne) {
    const Example e;
    const auto wide = SceneRenderer(320, 240).render(*toScene(e.cloud, e.result));
    for (const int width : {319, 318, 317}) {
        const auto picture = SceneRenderer(width, 240).render(*toScene(e.cloud, e.result));
        ASSERT_EQ(picture.getWidth(), static_cast<std::size_t>(width));
        ASSERT_EQ(picture.getHeight(), 240U);
        mrpt::img::CImage left;
        wide.extract_patch(left, 0, 0, static_cast<unsigned>(width), 240);
        for (unsigned row = 0; row < 240; ++row) {
            const auto* expected = left.ptrLine<std::uint8_t>(row);
            EXPECT_TRUE(std::equal(expected, expected + 3 * width, picture.ptrLine<std::uint8_t>(row))) << row;
        }
    }
}

TEST(SceneRenderer, AnImpossibleSizeIsRefused) { EXPECT_THROW(SceneRenderer(0, 100), std::invalid_argument); }

}  // namespace
}  // namespace lidar_obstacles
