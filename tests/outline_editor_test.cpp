// SPDX-License-Identifier: BSD-3-Clause
// Own body, region and zones as outlines: what a hand on a corner makes of them.
#include "outline_editor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_obstacles::apps {
namespace {

using testing::HasSubstr;

ZoneSet stopZone() {
    ZoneSet set;
    set.zones.push_back({"stop", ZoneFrame::Vehicle, {{4, -1}, {9, -1}, {9, 1}, {4, 1}}, {}});
    set.zones.push_back({"gate", ZoneFrame::Map, {{4, -1}, {9, -1}, {9, 1}}, {}});
    return set;
}

class Editor : public testing::Test {
  protected:
    Editor() { refresh(); }

    Eigen::Vector2f pixel(double x, double y) const { return *view_.pixelOf({x, y}); }
    void refresh() { editor_.take(params_, zones_, pose_); }
    /// Grabs the outline at a place and lets go at another. What comes out is taken over.
    void drag(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
        ASSERT_TRUE(editor_.wants(pixel(from.x(), from.y()), view_));
        editor_.grab(pixel(from.x(), from.y()), view_);
        editor_.dragTo(pixel(to.x(), to.y()), view_);
        take(editor_.release());
    }
    void take(const std::optional<EditedOutline>& outline) {
        ASSERT_TRUE(outline);
        const OutlineSetup setup = withOutline(*outline, {params_, zones_});
        params_ = setup.params;
        zones_ = setup.zones;
        refresh();
    }

    DetectorParams params_;  // own body: box(-1, 1, -0.6, 0.6)
    ZoneSet zones_ = stopZone();
    std::optional<Eigen::Isometry3d> pose_;  ///< not known
    GroundModel ground_;
    Projection projection_{{5, 0, 0, 180, 60, 30}, {0, 0, 800, 600}};
    GroundView view_{projection_, ground_};
    OutlineEditor editor_;
};

TEST_F(Editor, WithoutAPoseKnowsBodyRegionAndTheZonesOfTheVehicle) {
    std::vector<std::string> names;
    for (const EditedOutline& o : editor_.outlines()) names.push_back(o.name);
    EXPECT_THAT(names, testing::ElementsAre("own body", "region", "zone stop"));
}

TEST_F(Editor, AZoneOfTheMapLiesWhereThePoseHasItAndIsSavedOnTheMap) {
    const Outline before = zones_.zones[1].polygon;
    zones_.zones[1].polygon[0] = {4.0001, -1.0003};  // finer than a hand
    pose_ = Eigen::Translation3d(2, 4, 0.5) * Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitZ());
    refresh();
    ASSERT_EQ(editor_.outlines()[3].name, "zone gate");
    const Outline seen = editor_.outlines()[3].corners;
    EXPECT_NEAR((seen[1] - Eigen::Vector2d(5, 7)).norm(), 0.0, 1e-9)
        << "5 m below on the map, so ahead; 7 m to its left";
    drag({5, 7}, {5.5, 7.4});
    EXPECT_NEAR((zones_.zones[1].polygon[1] - Eigen::Vector2d(9.4, -1.5)).norm(), 0.0, 0.015);
    EXPECT_EQ(zones_.zones[1].polygon[0], Eigen::Vector2d(4.0001, -1.0003)) << "to the bit: it was not moved";
    EXPECT_EQ(zones_.zones[1].polygon[2], before[2]);
    EXPECT_EQ(zones_.zones[0].polygon, stopZone().zones[0].polygon);
}

TEST_F(Editor, AZoneOfTheMapFollowsThePoseButNotWhileAHandHoldsIt) {
    pose_ = Eigen::Isometry3d(Eigen::Translation3d(-2, 0, 0));
    refresh();
    editor_.grab(pixel(11, 1), view_);
    pose_ = Eigen::Isometry3d(Eigen::Translation3d(-1, 0, 0));
    refresh();
    editor_.dragTo(pixel(11, 2), view_);
    take(editor_.release());
    EXPECT_NEAR((zones_.zones[1].polygon[2] - Eigen::Vector2d(9, 2)).norm(), 0.0, 0.015);
    EXPECT_NEAR((editor_.outlines()[3].corners[2] - Eigen::Vector2d(10, 2)).norm(), 0.0, 0.015);
}

class EditorOnTheMap : public Editor {
  protected:
    EditorOnTheMap() {
        std::swap(zones_.zones[0], zones_.zones[1]);
        zones_.zones.push_back({"slow", ZoneFrame::Vehicle, {{12, -2}, {16, -2}, {16, 2}, {12, 2}}, {}});
        pose_ = Eigen::Isometry3d(Eigen::Translation3d(2, -4, 0));
        refresh();
    }
    void touch(double x, double y) {
        editor_.grab(pixel(x, y), view_);
        take(editor_.release());
    }
    void losePose() {
        pose_.reset();
        refresh();
    }
};

TEST_F(EditorOnTheMap, ATouchedCornerStaysWithItsZoneWhenOneBeforeDropsOut) {
    touch(9, -1);
    losePose();
    take(editor_.withoutCorner());
    EXPECT_EQ(zones_.zones[1].polygon, Outline({{4, -1}, {9, 1}, {4, 1}})) << "of stop";
    EXPECT_EQ(zones_.zones[2].polygon.size(), 4U) << "slow, which has taken its place";
}

TEST_F(EditorOnTheMap, ATouchedCornerOfAZoneThatDropsOutIsForgotten) {
    touch(7, 3);
    ASSERT_EQ(editor_.outlines()[editor_.chosen().value().outline].name, "zone gate");
    losePose();
    EXPECT_FALSE(editor_.withoutCorner());
    EXPECT_FALSE(editor_.chosen());
}

TEST_F(Editor, ACornerThatWasRefusedLeavesNoOtherOneTouched) {
    editor_.grab(pixel(9, 0), view_);
    editor_.dragTo(pixel(2, 0), view_);
    EXPECT_THROW(withOutline(*editor_.release(), {params_, zones_}), std::invalid_argument);
    refresh();
    EXPECT_FALSE(editor_.withoutCorner()) << "its side has no corner there any more";
}

TEST_F(Editor, APlaceOnTheGroundAndItsPixelBelongTogether) {
    const auto place = view_.placeAt(pixel(7.0, -2.5));
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->x(), 7.0, 1e-4);
    EXPECT_NEAR(place->y(), -2.5, 1e-4);
    const Projection flat({5, 0, 0, 180, 5, 30}, {0, 0, 800, 600});
    EXPECT_FALSE(GroundView(flat, ground_).placeAt({400, 0})) << "sky";
}

TEST_F(Editor, ACornerOfAZoneIsDraggedToCentimetres) {
    drag({9, 1}, {8.004, 1.496});
    EXPECT_NEAR((zones_.zones[0].polygon[2] - Eigen::Vector2d(8.0, 1.5)).norm(), 0.0, 0.011);
    EXPECT_EQ(zones_.zones[0].polygon[1], Eigen::Vector2d(9, -1));
    EXPECT_EQ(zones_.zones[0].polygon.size(), 4U);
}

TEST_F(Editor, ASideGetsACornerAndACornerIsTakenAway) {
    drag({9, 0}, {11, 0});
    ASSERT_EQ(zones_.zones[0].polygon.size(), 5U);
    EXPECT_NEAR((zones_.zones[0].polygon[2] - Eigen::Vector2d(11, 0)).norm(), 0.0, 0.011);
    ASSERT_TRUE(editor_.chosen()) << "it is the one that was touched last";
    take(editor_.withoutCorner());
    EXPECT_EQ(zones_.zones[0].polygon, stopZone().zones[0].polygon);
    EXPECT_FALSE(editor_.withoutCorner()) << "none was touched since";
}

TEST_F(Editor, ABoxOfTheBodyStaysOneWhileItsCornersAreDragged) {
    drag({1, 0.6}, {2, 0.9});
    EXPECT_EQ(params_.region.own_body, "box(-1, 2, -0.6, 0.9)");
    drag({-1, -0.6}, {-2, -0.5});
    EXPECT_EQ(params_.region.own_body, "box(-2, 2, -0.5, 0.9)");
    drag({2, 0.2}, {3, 0.2});
    EXPECT_THAT(params_.region.own_body, HasSubstr("polygon(-2 -0.5, 2 -0.5, 3 0.2, 2 0.9, -2 0.9)"));
}

TEST_F(Editor, ABoxWithHeightsDoesNotBecomeAPolygonWhichHasNone) {
    params_.region.own_body = "box(-1, 1, -0.6, 0.6, 0, 1.4)";
    refresh();
    drag({1, 0.6}, {1.5, 0.6});
    EXPECT_EQ(params_.region.own_body, "box(-1, 1.5, -0.6, 0.6, 0, 1.4)");
    editor_.grab(pixel(1.5, 0), view_);
    EXPECT_THROW(withOutline(*editor_.release(), {params_, zones_}), std::invalid_argument);
}

TEST_F(Editor, TheRegionReachesAsFarToBothSides) {
    params_.region.front = 12;
    params_.region.rear = 3;
    params_.region.lateral = 5;
    refresh();
    drag({12, 5}, {10, 6});
    EXPECT_NEAR(params_.region.front, 10.0, 0.011);
    EXPECT_NEAR(params_.region.lateral, 6.0, 0.011);
    EXPECT_EQ(params_.region.rear, 3.0);
    drag({-3, -6}, {2, -6});
    EXPECT_EQ(params_.region.rear, 1.0) << "the least that the parameter may be";
    EXPECT_FALSE(editor_.wants(pixel(10, 2), view_)) << "it has four corners";
    EXPECT_THROW(editor_.withoutCorner(), std::invalid_argument);
}

TEST_F(Editor, SidesThatCrossAreRefused) {
    editor_.grab(pixel(9, 1), view_);
    editor_.dragTo(pixel(6, -3), view_);
    EXPECT_THROW(withOutline(*editor_.release(), {params_, zones_}), std::invalid_argument);
    refresh();
    EXPECT_EQ(editor_.outlines()[2].corners, stopZone().zones[0].polygon) << "as it was";
}

TEST_F(Editor, AChangeFromElsewhereDoesNotTearACornerFromTheHand) {
    editor_.grab(pixel(9, 1), view_);
    editor_.dragTo(pixel(10, 1), view_);
    refresh();
    const auto outline = editor_.release();
    ASSERT_TRUE(outline);
    EXPECT_NEAR(outline->corners[2].x(), 10.0, 0.011);
}

}  // namespace
}  // namespace lidar_obstacles::apps
