// SPDX-License-Identifier: BSD-3-Clause
// The layers of a scene that lasts.
#include "lidar_obstacles/mrpt_bridge/scene_layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <cmath>

#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles {
namespace {

/// Two returns on the ground, two on a car, one of something rejected, one too high.
std::shared_ptr<LayerData> example() {
    auto data = std::make_shared<LayerData>();
    data->cloud.xyz = {{5, 0, 0}, {6, 0, 0}, {8, 3, 0.7F}, {8, 3.2F, 0.7F}, {-4, 2, 1}, {9, 9, 6}};
    data->cloud.intensity.assign(6, 0.5F);
    data->cloud.ring = {0, 1, 2, 3, 4, 5};
    DetectionResult& r = data->result;
    r.ground.is_ground = {1, 1, 0, 0, 0, 0};
    r.ground.height = {0.F, 0.F, 0.7F, 0.7F, 1.F, 6.F};
    r.candidates = {2, 3, 4};
    r.filtered = {5};
    r.grid.origin = {-10.0, -10.0};
    r.grid.resolution = 0.5;
    r.grid.width = 40;
    r.grid.height = 40;
    r.grid.occupied = {26 * 40 + 34, 26 * 40 + 36};
    r.grid.free = {20 * 40 + 30};
    Obstacle car;
    car.cls = ObstacleClass::Vehicle;
    car.box = {{8.0, 3.0, 0.75}, {4.0, 1.8, 1.5}, 0.5};
    car.heading_valid = true;
    car.points = {2, 3};
    car.rule = HeadingRule::TwoSides;
    car.hull = {{7, 2}, {9, 2}, {9, 4}};
    car.marks = {{7, 2}, {9, 2}, {9, 4}, {7, 4}};
    car.track.emplace();
    car.track->velocity = Eigen::Vector2d(4.0, 0.0);
    car.track->moving = true;
    data->tails = {{car.id, {{5.0, 3.0, 0.75}, {8.0, 3.0, 0.75}}}};
    r.obstacles = {car};
    RejectedCluster rejected;
    rejected.cluster.points = {4};
    r.clusters.rejected = {rejected};
    data->truth = {{"car 1", car.box}};
    data->voxels = {{1, 1, 1}};
    r.hypotheses.resize(3);
    r.hypotheses[0].points = {2};
    r.hypotheses[1].points = {3, 4};
    r.hypotheses[2].points = {2, 3, 4};
    r.hypotheses[2].part = {0, 1};
    r.hypotheses[0].parent = r.hypotheses[1].parent = 2;
    data->zones = {{"stop", ZoneState::Occupied, ZoneReason::Returns, {{2, -1}, {5, -1}, {5, 1}, {2, 1}}}};
    data->region.front = data->region.rear = data->region.lateral = 8.0;
    return data;
}

LayerSet only(std::initializer_list<Layer> layers) {
    LayerSet set;
    for (const Layer l : layers) set.set(static_cast<std::size_t>(l));
    return set;
}

std::size_t pointsIn(const SceneLayers& layers, const std::string& name) {
    return std::dynamic_pointer_cast<mrpt::opengl::CPointCloudColoured>(layers.scene()->getByName(name))->size();
}

std::size_t objectsIn(const SceneLayers& layers) {
    std::size_t n = 0;
    for (const auto& object : *layers.scene()->getViewport()) n += object ? 1 : 0;
    return n;
}

TEST(SceneLayers, EachNameLeadsToItsLayer) {
    for (std::size_t k = 0; k < kLayers; ++k)
        EXPECT_EQ(layerOf(toString(static_cast<Layer>(k))), static_cast<Layer>(k));
    EXPECT_EQ(layerOf("Raw"), std::nullopt);
}

TEST(SceneLayers, AReturnIsDrawnOnceInTheMostTellingVisibleLayer) {
    SceneLayers layers;
    layers.setScan(example());
    EXPECT_EQ(pointsIn(layers, "raw"), 0U) << "nothing is visible at first";
    layers.setVisible(only({Layer::Raw}));
    EXPECT_EQ(layers.count(Layer::Raw), 6U);
    layers.setVisible(only({Layer::Raw, Layer::Ground, Layer::Candidates}));
    EXPECT_EQ(pointsIn(layers, "raw"), 1U);
    EXPECT_EQ(pointsIn(layers, "ground"), 2U);
    EXPECT_EQ(pointsIn(layers, "candidates"), 3U);
    layers.setVisible(LayerSet().set());
    EXPECT_EQ(pointsIn(layers, "candidates"), 0U);
    EXPECT_EQ(pointsIn(layers, "clusters"), 2U);
    EXPECT_EQ(pointsIn(layers, "rejected"), 1U);
    EXPECT_EQ(pointsIn(layers, "filtered"), 1U);
    layers.setVisible(only({Layer::Clusters}));
    EXPECT_EQ(layers.count(Layer::Clusters), 2U);
    EXPECT_EQ(layers.count(Layer::Rejected), 0U);
}

TEST(SceneLayers, CountWhatTheyShow) {
    SceneLayers layers;
    layers.setScan(example());
    layers.setVisible(LayerSet().set());
    EXPECT_EQ(layers.count(Layer::Grid), 2U);
    EXPECT_EQ(layers.count(Layer::Morphology), 2U);
    for (const Layer l : {Layer::Fit, Layer::Boxes, Layer::Tracks, Layer::Labels, Layer::Truth, Layer::Voxels,
                          Layer::Merges, Layer::Zones, Layer::Region})
        EXPECT_EQ(layers.count(l), 1U) << toString(l);
    layers.setVisible({});
    for (std::size_t k = 0; k < kLayers; ++k) EXPECT_EQ(layers.count(static_cast<Layer>(k)), 0U);
}

TEST(SceneLayers, MakeNoNewObjectsForTheNextScans) {
    SceneLayers layers;
    layers.setVisible(LayerSet().set());
    layers.setScan(example());
    const std::size_t objects = objectsIn(layers);
    for (int k = 0; k < 20; ++k) {
        auto other = example();
        if (k % 2 == 0) other->result.obstacles.clear();
        layers.setScan(other);
        layers.setVisible(k % 3 == 0 ? LayerSet{} : LayerSet().set());
        layers.setPointColor(static_cast<PointColor>(k % 3));
    }
    EXPECT_EQ(objectsIn(layers), objects);
}

TEST(SceneLayers, ATrackHasATailAndIfItMovesAnArrow) {
    SceneLayers layers;
    layers.setVisible(only({Layer::Tracks}));
    const auto tails = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(layers.scene()->getByName("tails"));
    const auto speeds = std::dynamic_pointer_cast<mrpt::opengl::CSetOfTriangles>(layers.scene()->getByName("speeds"));
    ASSERT_TRUE(tails && speeds);
    layers.setScan(example());
    EXPECT_EQ(tails->size(), 1U);
    EXPECT_EQ(speeds->getTrianglesCount(), 3U);
    auto standing = example();
    standing->result.obstacles.front().track->moving = false;
    layers.setScan(standing);
    EXPECT_EQ(layers.count(Layer::Tracks), 1U);
    EXPECT_EQ(speeds->getTrianglesCount(), 0U);
}

/// An arrow's triangles, as seen by who looks along it.
struct ArrowSize {
    double length = 0.0;  ///< from the box's centre to the tip [m]
    double width = 0.0;   ///< of the head [m]
    double head = 0.0;    ///< its length [m]
};
ArrowSize arrowSize(const SceneLayers& layers, const std::string& name, double yaw) {
    const auto triangles = std::dynamic_pointer_cast<mrpt::opengl::CSetOfTriangles>(layers.scene()->getByName(name));
    EXPECT_EQ(triangles->getTrianglesCount(), 3U);
    const auto along = [&](float x, float y) { return std::cos(yaw) * (x - 8.0) + std::sin(yaw) * (y - 3.0); };
    const auto across = [&](float x, float y) { return -std::sin(yaw) * (x - 8.0) + std::cos(yaw) * (y - 3.0); };
    mrpt::opengl::TTriangle head;
    triangles->getTriangle(2, head);
    return {along(head.x(1), head.y(1)), across(head.x(2), head.y(2)) - across(head.x(0), head.y(0)),
            along(head.x(1), head.y(1)) - along(head.x(0), head.y(0))};
}

TEST(SceneLayers, ArrowsAreAsWideInThePictureFromFarAwayAndAsLongOnTheGround) {
    SceneLayers layers;
    layers.setVisible(only({Layer::Boxes, Layer::Tracks}));
    layers.setScan(example());
    const ArrowSize speed = arrowSize(layers, "speeds", 0.0), heading = arrowSize(layers, "headings", 0.5);
    EXPECT_NEAR(speed.length, 4.0, 1e-5) << "4 m/s for a second";
    layers.setViewDistance(2.0 * CameraView{}.distance);
    const ArrowSize far_speed = arrowSize(layers, "speeds", 0.0), far_heading = arrowSize(layers, "headings", 0.5);
    EXPECT_NEAR(far_speed.length, 4.0, 1e-5);
    EXPECT_NEAR(far_speed.width, 2.0 * speed.width, 1e-5);
    EXPECT_NEAR(far_speed.head, 2.0 * speed.head, 1e-5);
    EXPECT_NEAR(far_heading.width, 2.0 * heading.width, 1e-5);
    EXPECT_NEAR(far_heading.length - 2.0, 2.0 * (heading.length - 2.0), 1e-5) << "out of the front, 2 m ahead";
    layers.setScan(example());
    EXPECT_NEAR(arrowSize(layers, "speeds", 0.0).width, far_speed.width, 1e-5) << "the next scan's, too";
}

TEST(SceneLayers, ArrowsAreMadeAnewOnlyForAChangeOfMoreThanAQuarter) {
    SceneLayers layers;
    layers.setVisible(only({Layer::Tracks}));
    layers.setScan(example());
    const double width = arrowSize(layers, "speeds", 0.0).width;
    const double usual = CameraView{}.distance;
    for (const double distance : {1.2 * usual, usual / 1.2}) {
        layers.setViewDistance(distance);
        EXPECT_EQ(arrowSize(layers, "speeds", 0.0).width, width) << distance;
    }
    layers.setViewDistance(1.3 * usual);
    EXPECT_NEAR(arrowSize(layers, "speeds", 0.0).width, 1.3 * width, 1e-5);
}

TEST(SceneLayers, AShortArrowIsNotWiderThanLong) {
    SceneLayers layers;
    layers.setVisible(only({Layer::Tracks}));
    auto slow = example();
    slow->result.obstacles.front().track->velocity = Eigen::Vector2d(0.8, 0.0);
    layers.setScan(slow);
    layers.setViewDistance(8.0 * CameraView{}.distance);
    const ArrowSize speed = arrowSize(layers, "speeds", 0.0);
    EXPECT_NEAR(speed.length, 0.8, 1e-5);
    EXPECT_LT(speed.width, speed.length);
}

TEST(SceneLayers, ShowTheOwnBodyOfEachScan) {
    SceneLayers layers;
    const auto lines = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(layers.scene()->getByName("own_body"));
    ASSERT_TRUE(lines);
    auto data = example();
    data->own_body = OwnBody("box(-1, 2, -0.9, 0.9)");
    layers.setScan(data);
    EXPECT_EQ(lines->size(), 12U);
    layers.setScan(example());
    EXPECT_EQ(lines->size(), 0U);
}

TEST(SceneLayers, ShowTheOutlineAndTheExcludedPlacesWithTheRegion) {
    SceneLayers layers;
    layers.setVisible(LayerSet().set());
    const auto linesOf = [&](const char* name) {
        return std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(layers.scene()->getByName(name))->size();
    };
    layers.setScan(example());
    EXPECT_EQ(linesOf("region"), 4U * 16U) << "the rectangle of 16 m, metre by metre";
    EXPECT_EQ(linesOf("excluded"), 0U);
    auto data = example();
    data->region.outline = "box(0, 2, 0, 2)";
    data->region.excluded = "box(5, 6, 0, 1)";
    layers.setScan(data);
    EXPECT_EQ(linesOf("region"), 4U * 2U);
    EXPECT_EQ(linesOf("excluded"), 4U);
}

TEST(SceneLayers, LeaveTheirTextsToWhoDrawsThemBetter) {
    SceneLayers layers;
    layers.setVisible(LayerSet().set());
    layers.setScan(example());
    const std::size_t with_texts = objectsIn(layers);
    SceneLayers bare(false);
    bare.setVisible(LayerSet().set());
    bare.setScan(example());
    const auto texts = bare.texts();
    EXPECT_EQ(objectsIn(bare) + texts.size(), with_texts);
    std::vector<std::string> words;
    for (const SceneText& t : texts) words.push_back(t.text);
    EXPECT_THAT(words, testing::IsSupersetOf({"stop: occupied (returns)", "10 m", "60 m", "car 1", "A", "D"}));
}

TEST(SceneLayers, ShowEmptyScans) {
    SceneLayers layers;
    layers.setVisible(LayerSet().set());
    layers.setScan(example());
    layers.setScan(std::make_shared<LayerData>());
    for (std::size_t k = 0; k < kLayers; ++k) EXPECT_EQ(layers.count(static_cast<Layer>(k)), 0U);
    auto other = std::make_shared<LayerData>();
    other->result.ground.is_ground = {1};
    EXPECT_THROW(layers.setScan(other), std::invalid_argument);
}

/// Brightness of a picture from above.
double brightness(SceneLayers& layers, SceneRenderer& renderer, const LayerSet& visible) {
    layers.setVisible(visible);
    const auto picture = renderer.render(*layers.scene(), {{4, 0, 0}, 50.0, 180.0, 60.0});
    double sum = 0.0;
    for (unsigned y = 0; y < picture.getHeight(); ++y)
        for (unsigned x = 0; x < 3 * picture.getWidth(); ++x) sum += picture.ptrLine<std::uint8_t>(y)[x];
    return sum;
}

TEST(SceneLayers, EachOneChangesThePicture) {
    SceneLayers layers;
    layers.setScan(example());
    SceneRenderer renderer(400, 400);
    const double nothing = brightness(layers, renderer, {});
    for (std::size_t k = 0; k < kLayers; ++k) {
        LayerSet one;
        one.set(k);
        EXPECT_GT(brightness(layers, renderer, one), nothing + 100.0) << toString(static_cast<Layer>(k));
    }
    EXPECT_EQ(brightness(layers, renderer, {}), nothing);
}

}  // namespace
}  // namespace lidar_obstacles
