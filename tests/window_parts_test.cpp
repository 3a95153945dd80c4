// SPDX-License-Identifier: BSD-3-Clause
// What the window is made of, without a window: where things are on the screen, labels, histories, marks, reasons.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "explain.h"
#include "history.h"
#include "label_layout.h"
#include "lidar_obstacles/features.h"
#include "overlay.h"
#include "phantoms.h"
#include "projection.h"
#include "survey.h"

#include <chrono>
#include <cmath>
#include <thread>

namespace lidar_obstacles::apps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const ScreenRect kScene{0, 0, 800, 600};
const CameraPlace kBehind{8, 0, 0, 180, 32, 38};

Obstacle boxAt(int id, double x, double y) {
    Obstacle o;
    o.id = id;
    o.cls = ObstacleClass::Vehicle;
    o.box = {{x, y, 0.75}, {4.0, 1.8, 1.5}, 0.0};
    return o;
}

Obstacle tracked(int id, double age, ObstacleClass cls = ObstacleClass::Vehicle) {
    Obstacle o = boxAt(id, 10.0 + id, 0.0);
    o.cls = cls;
    o.track.emplace();
    o.track->age = age;
    o.track->velocity = Eigen::Vector2d(3.0, 4.0);
    o.track->moving = true;
    return o;
}

DetectionResult found(const std::vector<Obstacle>& obstacles, GroundEvidence ground = GroundEvidence::Good) {
    DetectionResult r;
    r.obstacles = obstacles;
    r.ground.evidence = ground;
    return r;
}

TEST(Projection, WhatTheCameraLooksAtIsInTheMiddle) {
    const Projection p(kBehind, {100, 50, 600, 400});
    ASSERT_TRUE(p.pixelOf({8, 0, 0}));
    EXPECT_NEAR(p.pixelOf({8, 0, 0})->x(), 400.0, 1e-3);
    EXPECT_NEAR(p.pixelOf({8, 0, 0})->y(), 250.0, 1e-3);
    EXPECT_LT(p.pixelOf({8, 3, 0})->x(), 400.0) << "left of the vehicle is left on the screen, seen from behind";
    EXPECT_LT(p.pixelOf({8, 0, 2})->y(), 250.0) << "higher is higher";
    EXPECT_FALSE(p.pixelOf({-60, 0, 0})) << "behind the camera";
}

TEST(Projection, TheUpperEdgeIs15DegreesAboveTheMiddle) {
    const Projection p({0, 0, 0, 180, 0, 10}, kScene);
    EXPECT_NEAR(p.pixelOf({0, 0, 10 * std::tan(15 * M_PI / 180)})->y(), 0.0, 1e-3);
}

TEST(Projection, ARayThroughThePixelOfAPointMeetsIt) {
    for (const float elevation : {10.F, 32.F, 90.F}) {
        const Projection p({8, 1, 0, 150, elevation, 38}, kScene);
        const Eigen::Vector3d point(12, -3, 1);
        const auto pixel = p.pixelOf(point);
        ASSERT_TRUE(pixel);
        const Eigen::Vector3d way = (point - p.eye()).normalized();
        EXPECT_NEAR((p.rayThrough(pixel->x(), pixel->y()) - way).norm(), 0.0, 1e-5) << elevation;
    }
}

TEST(Click, HitsTheNearestOfTheBoxesInOneLine) {
    const Projection p(kBehind, kScene);
    const std::vector<Obstacle> boxes = {boxAt(0, 14, 0), boxAt(1, 8, 0), boxAt(2, 8, 6)};
    const auto at = [&](const Eigen::Vector3d& point) {
        const auto pixel = p.pixelOf(point);
        return obstacleAt(boxes, p, pixel->x(), pixel->y());
    };
    EXPECT_EQ(at({8, 0, 0.75}), 1U);
    EXPECT_EQ(at({14, 0, 1.4}), 0U);
    EXPECT_EQ(at({8, 6.5, 0.5}), 2U);
    EXPECT_EQ(at({8, -6, 0}), std::nullopt);
}

TEST(Click, BesideASmallBoxMeansItNonetheless) {
    const Projection p(kBehind, kScene);
    std::vector<Obstacle> boxes = {boxAt(0, 40, 0)};
    boxes[0].box.size = {0.1, 0.1, 0.1};
    const auto pixel = p.pixelOf(boxes[0].box.center);
    EXPECT_EQ(obstacleAt(boxes, p, pixel->x() + 8, pixel->y()), 0U);
    EXPECT_EQ(obstacleAt(boxes, p, pixel->x() + 20, pixel->y()), std::nullopt);
}

TEST(Labels, DoNotCoverEachOther) {
    std::vector<SceneText> texts;
    for (int k = 0; k < 40; ++k) texts.push_back({"vehicle " + std::to_string(k), {8.0 + 0.1 * k, 0.0, 1.0}, {}, 0});
    texts.push_back({"heavy", {9.0, 0.0, 1.0}, {}, 3});
    const auto labels = placeLabels(texts, Projection(kBehind, kScene), {kScene, {{0, 0, 800, 100}}}, {7, 13});
    EXPECT_GT(labels.size(), 4U);
    EXPECT_LT(labels.size(), texts.size()) << "some find no place";
    EXPECT_EQ(labels[0].text, "heavy");
    for (std::size_t a = 0; a < labels.size(); ++a) {
        EXPECT_GE(labels[a].at.y, 100.F);
        for (std::size_t b = 0; b < a; ++b) EXPECT_FALSE(labels[a].at.meets(labels[b].at)) << labels[a].text;
    }
}

TEST(Labels, StayInsideTheScene) {
    const Projection p(kBehind, kScene);
    const auto labels =
        placeLabels({{"a very long text at the left edge", {8, 9, 0}, {}, 0}, {"far off", {8, 60, 0}, {}, 0}}, p,
                    {kScene, {}}, {7, 13});
    ASSERT_EQ(labels.size(), 1U);
    EXPECT_GE(labels[0].at.x, 0.F);
}

TEST(History, HoldsSpeedDistanceSizeAndClasses) {
    History h;
    h.add(found({tracked(1, 0.0)}), 100.0);
    Obstacle longer = tracked(1, 0.1);
    longer.box.size.x() = 4.5;
    longer.probability[1] = 0.75F;
    h.add(found({longer, tracked(2, 0.0, ObstacleClass::Structure)}), 100.1);
    ASSERT_EQ(h.of(1).size(), 2U);
    EXPECT_EQ(h.of(1)[1].time, 100.1);
    EXPECT_FLOAT_EQ(h.of(1)[1].speed.value(), 5.F);
    EXPECT_FLOAT_EQ(h.of(1)[1].distance, 8.75F);
    EXPECT_EQ(h.of(1)[0].size, Eigen::Vector3f(4.F, 1.8F, 1.5F)) << "length, width, height";
    EXPECT_EQ(h.of(1)[1].size, Eigen::Vector3f(4.5F, 1.8F, 1.5F));
    EXPECT_EQ(h.of(1)[1].classes[1], 0.75F);
    EXPECT_TRUE(h.of(2).empty()) << "structure";
    EXPECT_EQ(h.at(1, {11.2, 0.1}), 1);
    EXPECT_EQ(h.at(1, {12.2, 0.1}), std::nullopt);
    EXPECT_EQ(h.at(7, {11.0, 0.0}), std::nullopt);
}

TEST(History, ForgetsWhatIsTooOld) {
    History h(1.0);
    for (int k = 0; k < 50; ++k) h.add(found({tracked(k < 30 ? 1 : 2, 1.0)}), 0.1 * k);
    EXPECT_TRUE(h.of(1).empty());
    EXPECT_NEAR(h.of(2).front().time, 3.9, 1e-6);
}

TEST(Marks, NameNewAndLostTracksLostGroundAndLateScans) {
    History h;
    h.add(found({tracked(1, 0.0)}), 0.0);
    h.add(found({tracked(1, 0.1)}), 0.1);
    h.add(found({tracked(1, 0.2), tracked(2, 0.0)}), 0.2);
    h.add(found({tracked(1, 0.3), tracked(2, 0.1)}, GroundEvidence::None), 0.3);
    h.add(found({tracked(2, 0.2)}), 0.6);
    std::vector<std::pair<std::size_t, std::string>> marks;
    for (const Mark& m : h.marks()) marks.emplace_back(m.scan, std::string(toString(m.kind)) + ": " + m.text);
    using P = std::pair<std::size_t, std::string>;
    ASSERT_EQ(marks.size(), 4U);
    EXPECT_THAT(marks, testing::IsSupersetOf({P{3, "ground lost: no ground"}, P{3, "new track: vehicle 2 is new"},
                                              P{3, "lost track: vehicle 1 is lost"}}));
    EXPECT_EQ(marks.back().first, 4U);
    EXPECT_THAT(marks.back().second, StartsWith("late scan: 3"));
    EXPECT_EQ(nextMark(h.marks(), 0, 1), 3U);
    EXPECT_EQ(nextMark(h.marks(), 3, 1), 4U);
    EXPECT_EQ(nextMark(h.marks(), 4, 1), std::nullopt);
    EXPECT_EQ(nextMark(h.marks(), 4, -1), 3U);
}

TEST(Phantoms, AreRoadUsersThatTouchNoLabelledObject) {
    const std::vector<TruthBox> truth = {{"car 1", boxAt(0, 11, 0).box}};
    Obstacle near_edge = boxAt(2, 15.2, 0), hidden = tracked(4, 1.0), hedge = boxAt(5, 20, 5);  // .2 m from the truth
    hidden.box = boxAt(0, 20, 9).box;
    hidden.track->seen = false;
    hedge.cls = ObstacleClass::Structure;
    const std::vector<Obstacle> found = {boxAt(1, 12, 0.5), near_edge,      boxAt(3, 15.4, 0), hidden, hedge,
                                         boxAt(6, 40, 0),   boxAt(7, -9, 0)};
    EXPECT_THAT(phantomsIn(found, truth, 360.0), ElementsAre(3, 7)) << "6 is beyond 30 m";
    EXPECT_THAT(phantomsIn(found, truth, 80.0), ElementsAre(3)) << "what lies behind is not labelled";
    EXPECT_THAT(phantomsIn(found, {}, 360.0), ElementsAre()) << "a scan that is not labelled";
}

TEST(Marks, NameAPhantomWhereItBegins) {
    History h;
    h.add(found({tracked(1, 0.0)}), 0.0);
    h.add(found({tracked(1, 0.1)}), 0.1, {{1}});
    h.add(found({tracked(1, 0.2)}), 0.2, {{1}});
    h.add(found({tracked(1, 0.3)}), 0.3);
    h.add(found({tracked(1, 0.4)}), 0.4, {{1}});
    std::vector<std::size_t> scans;
    for (const Mark& m : h.marks()) {
        if (m.kind != MarkKind::Phantom) continue;
        scans.push_back(m.scan);
        EXPECT_EQ(m.text, "vehicle 1 where the truth has nothing");
    }
    EXPECT_THAT(scans, ElementsAre(1, 4)) << "once each time";
}

TEST(Time, IsInUtc) { EXPECT_EQ(recordingTime(1453364282.345), "2016-01-21 08:18:02.345 UTC"); }

class Street : public testing::Test {
  protected:
    Street() : store_(STREET_SAMPLE, {{}, 0, 7, 1}), player_(store_, {}, {}) {
        store_.waitFor(7);
        while (!store_.complete() || (player_.poses() && !player_.poses()->complete()))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        player_.tick(0.0);
    }
    ScanStore store_;
    Player player_;
};

TEST_F(Street, ReasonsNameClassPiecesAndMerges) {
    player_.last();
    player_.tick(0.0);
    const auto& scan = *player_.shown();
    std::size_t merges = 0;
    for (const Obstacle& o : scan.result.obstacles) {
        const auto lines = reasonsOf(o, scan);
        if (o.cls != ObstacleClass::Vehicle || o.points.empty()) continue;
        EXPECT_THAT(lines[0], HasSubstr("vehicle"));
        for (const std::string& line : lines) merges += line.find("joined: ") != std::string::npos ? 1 : 0;
    }
    EXPECT_GT(merges, 3U);
}

TEST_F(Street, FeaturesAreWhatTheRecognizerMeasured) {
    const auto& scan = *player_.shown();
    std::size_t told = 0;
    for (const Obstacle& o : scan.result.obstacles) {
        const auto features = featuresOf(o, scan);
        if (features.empty()) continue;
        ++told;
        EXPECT_EQ(features.size(), static_cast<std::size_t>(Feature::Apart))
            << "those of what was thought of others are left out";
        for (const Line& f : features) EXPECT_FALSE(f.meaning.empty()) << f.name;
        EXPECT_EQ(features[0].name, "returns");
        if (o.cls != ObstacleClass::Vehicle) continue;
        EXPECT_NEAR(std::exp2(std::stod(features[0].value)), o.num_points, 0.02 * o.num_points + 1.0);
    }
    EXPECT_GT(told, 5U);
    Obstacle none;
    EXPECT_TRUE(featuresOf(none, scan).empty());
}

TEST_F(Street, TheSurveyKnowsTheHistoryOfABoxOfTheScanThatIsShown) {
    Survey survey;
    while (survey.step(player_)) {
    }
    EXPECT_TRUE(survey.complete(player_));
    player_.last();
    player_.tick(0.0);
    std::size_t longest = 0;
    for (const Obstacle& o : player_.shown()->result.obstacles)
        longest = std::max(longest, survey.of(o, player_).size());
    EXPECT_GE(longest, 5U) << "of 8 scans";
    player_.setParams(player_.setup().params);
    EXPECT_FALSE(survey.complete(player_)) << "other parameters find something else";
}

TEST_F(Street, ARangeIsPlayedAndLooped) {
    EXPECT_THROW(player_.setRange(std::pair<std::size_t, std::size_t>(3, 3)), std::invalid_argument);
    player_.setRange(std::pair<std::size_t, std::size_t>(2, 4));
    player_.setLoop(true);
    player_.play(0.0);
    std::vector<std::size_t> shown;
    for (int k = 1; k < 9; ++k) {
        player_.tick(10.0 * k);
        shown.push_back(player_.position());
    }
    EXPECT_THAT(shown, ElementsAre(2, 3, 4, 2, 3, 4, 2, 3));
    player_.setLoop(false);
    for (int k = 9; k < 12; ++k) player_.tick(10.0 * k);
    EXPECT_EQ(player_.position(), 4U);
    EXPECT_FALSE(player_.playing());
}

}  // namespace
}  // namespace lidar_obstacles::apps
