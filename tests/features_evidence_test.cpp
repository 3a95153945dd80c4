// SPDX-License-Identifier: BSD-3-Clause
// What the beams around a group prove: through it, below it, before it, and what it goes on into. Degenerate groups.
#include <gtest/gtest.h>

#include "lidar_obstacles/feature_extractor.h"
#include "support/feature_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// Four bars across the view 8 m ahead, where the rings of -11, -7, -3 and 1 deg hit them; a wall 12 m ahead.
std::vector<OrientedBox> barsAndWall() {
    std::vector<OrientedBox> boxes;
    for (const double elevation : {-11.0, -7.0, -3.0, 1.0}) {
        const double z = 1.8 + 8.0 * std::tan(radians(elevation));
        boxes.push_back(wallAt(8.0, -0.8, 0.8, z - 0.06, z + 0.06));
    }
    boxes.push_back(wallAt(12.0, -4.0, 4.0, 0.0, 4.0));
    return boxes;
}

TEST(Evidence, BeamsThroughAPorousThingAreCounted) {
    const Scan scan = scanOf(barsAndWall());
    const FeatureVector f = featuresOf(scan, returnsOnAll(scan, {0, 1, 2, 3}));
    EXPECT_NEAR(of(f, Feature::Through), 3.0 / 7.0, 0.02) << "-9, -5 and -1 deg between four that hit";
    EXPECT_EQ(of(f, Feature::Rings), 4.0f);
}

TEST(Evidence, NoBeamPassesThroughAWall) {
    const FeatureVector f = featuresOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0), wallAt(12.0, -4.0, 4.0, 0.0, 4.0)});
    EXPECT_EQ(of(f, Feature::Through), 0.0f);
    EXPECT_EQ(of(f, Feature::Under), 0.0f);
    EXPECT_EQ(of(f, Feature::Floating), 0.0f);
    EXPECT_EQ(of(f, Feature::Hidden), 0.0f);
    EXPECT_EQ(of(f, Feature::GroundInside), 0.0f);
}

TEST(Evidence, AThingThatFloatsHasBeamsBelowIt) {
    // the board begins at 1 m: the rings of -11, -9 and -7 deg pass below it and meet the ground at 9.3 to 14.7 m
    const FeatureVector f = featuresOf({wallAt(8.0, -1.0, 1.0, 1.0, 2.0)});
    EXPECT_NEAR(of(f, Feature::Floating), 1.0, 1e-5);
    EXPECT_NEAR(of(f, Feature::Under), 3.0, 0.1) << "beams in each column";
    EXPECT_EQ(of(f, Feature::Through), 0.0f);
}

TEST(Evidence, AThingOverADarkPitProvesNothing) {
    World world;  // nothing comes back from below
    world.boxes = {wallAt(8.0, -1.0, 1.0, 1.0, 2.0)};
    const Scan scan = castRays(world, Sensor{});
    EXPECT_EQ(of(featuresOf(scan, scan.returnsOn(0)), Feature::Floating), 0.0f);
}

TEST(Evidence, WhatStandsNearerHidesABeam) {
    // a low wall 4 m ahead ends the beams of -15 and -13 deg; seven rings hit the wall behind it
    const FeatureVector f = featuresOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0), wallAt(4.0, -2.0, 2.0, 0.0, 0.9)});
    EXPECT_NEAR(of(f, Feature::Hidden), 2.0 / 9.0, 0.01);
}

TEST(Evidence, GroundBetweenNearAndFarSideIsSeen) {
    // a kerb 6 m ahead, the ground at 7.8 m, a wall at 10 m: no car
    const Scan scan = scanOf({wallAt(6.0, -1.0, 1.0, 0.0, 0.3), wallAt(10.0, -1.6, 1.6, 0.0, 2.0)});
    EXPECT_NEAR(of(featuresOf(scan, returnsOnAll(scan, {0, 1})), Feature::GroundInside), 1.0, 0.1);
    EXPECT_EQ(of(featuresOf({carAt(10.0, 0.0, 0.0)}), Feature::GroundInside), 0.0f);
}

/// Two boxes of a car's height beside each other 8 m ahead, 1 m of nothing between them.
std::vector<OrientedBox> twoBeside() { return {wallAt(8.0, -1.5, -0.5, 0.0, 1.5), wallAt(8.0, 0.5, 1.5, 0.0, 1.5)}; }

TEST(Evidence, AGapThatBeamsPassedIsFree) {
    std::vector<OrientedBox> boxes = twoBeside();
    boxes.push_back(wallAt(12.0, -4.0, 4.0, 0.0, 4.0));
    const Scan scan = scanOf(boxes);
    const FeatureVector f = featuresOf(scan, returnsOnAll(scan, {0, 1}));
    EXPECT_NEAR(of(f, Feature::GapShare), 1.0 / 3.0, 0.03);
    EXPECT_NEAR(of(f, Feature::GapFree), 1.0, 0.06);
    EXPECT_EQ(of(f, Feature::GapHidden), 0.0f);
}

TEST(Evidence, AGapBehindAPostIsHidden) {
    std::vector<OrientedBox> boxes = twoBeside();
    boxes.push_back(boxAt(4.0, 0.0, 0.0, {0.1, 0.6, 3.0}));  // hides 1.2 m of what is 8 m ahead
    boxes.push_back(wallAt(12.0, -4.0, 4.0, 0.0, 4.0));
    const Scan scan = scanOf(boxes);
    const FeatureVector f = featuresOf(scan, returnsOnAll(scan, {0, 1}));
    EXPECT_NEAR(of(f, Feature::GapHidden), 1.2, 0.08);
    EXPECT_EQ(of(f, Feature::GapFree), 0.0f);
}

TEST(Evidence, AGapInWhichNothingCameBackIsNeither) {
    World dark;  // no ground, nothing behind
    dark.boxes = twoBeside();
    const Scan scan = castRays(dark, Sensor{});
    const FeatureVector f = featuresOf(scan, returnsOnAll(scan, {0, 1}));
    EXPECT_NEAR(of(f, Feature::GapShare), 1.0 / 3.0, 0.03);
    EXPECT_EQ(of(f, Feature::GapFree), 0.0f);
    EXPECT_EQ(of(f, Feature::GapHidden), 0.0f);
    EXPECT_EQ(of(featuresOf({wallAt(8.0, -1.0, 1.0, 0.0, 1.5)}), Feature::GapShare), 0.0f) << "a wall has none";
}

TEST(Evidence, AWallThatGoesOnBesideTheGroupGoesOn) {
    const Scan scan = scanOf({wallAt(8.0, -2.0, 3.0, 0.0, 2.0)});
    const auto part = [&](float from, float to) {
        const FeatureVector f = featuresOf(
            scan, returnsWhere(scan, 0, [&](const Eigen::Vector3f& p) { return p.y() > from && p.y() < to; }));
        return std::pair(of(f, Feature::GoesOnMore), of(f, Feature::GoesOnLess));
    };
    EXPECT_EQ(part(-1.0f, 1.0f), std::pair(1.0f, 1.0f)) << "its middle";
    EXPECT_EQ(part(-5.0f, 1.0f), std::pair(1.0f, 0.0f)) << "its right end";
    EXPECT_EQ(part(0.0f, 5.0f), std::pair(1.0f, 0.0f)) << "its left end";
    EXPECT_EQ(part(-5.0f, 5.0f), std::pair(0.0f, 0.0f)) << "all of it";
}

TEST(Evidence, WhatAPostHidesBesideTheGroupIsHidden) {
    // seen from the sensor the post covers the wall's left end
    const FeatureVector f = featuresOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0), boxAt(4.0, 1.0, 0.0, {0.2, 1.5, 3.0})});
    EXPECT_EQ(of(f, Feature::HiddenMore), 1.0f);
    EXPECT_EQ(of(f, Feature::HiddenLess), 0.0f);
    EXPECT_EQ(of(f, Feature::GoesOnMore), 0.0f);
    const FeatureVector free = featuresOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0), wallAt(12.0, -4.0, 4.0, 0.0, 4.0)});
    EXPECT_EQ(of(free, Feature::HiddenMore), 0.0f) << "what is behind hides nothing";
}

TEST(Evidence, ASurfaceThatGoesOnAboveAndBelowIsFollowed) {
    const Scan scan = scanOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0)});
    const FeatureVector middle =
        featuresOf(scan, returnsWhere(scan, 0, [](const Eigen::Vector3f& p) { return p.z() > 0.5f && p.z() < 1.2f; }));
    EXPECT_EQ(of(middle, Feature::GoesUp), 1.0f);
    EXPECT_EQ(of(middle, Feature::GoesDown), 1.0f);
    const FeatureVector all = featuresOf(scan, scan.returnsOn(0));
    EXPECT_EQ(of(all, Feature::GoesUp), 0.0f);
    EXPECT_EQ(of(all, Feature::GoesDown), 0.0f) << "below it is the ground";
}

TEST(Evidence, AcrossTheSeamOfTheScanAGroupMeasuresTheSame) {
    // columns run from straight behind to straight behind, so the one behind is cut in two
    const FeatureVector ahead = featuresOf({carAt(10.0, 0.0, 0.0)});
    const FeatureVector behind = featuresOf({carAt(-10.0, 0.0, 0.0)});
    for (std::size_t k = 0; k < kFeatures; ++k)
        EXPECT_NEAR(behind[k], ahead[k], 0.01f + 0.02f * std::abs(ahead[k])) << featureInfos()[k].name;
}

TEST(Evidence, AHoleOfTheScanIsNoGapOfTheGroup) {
    const Scan whole = scanOf({carAt(10.0, 0.0, 0.0)});
    const Scan cut = without(whole, [&](std::int32_t i) {
        const Eigen::Vector3f& p = whole.cloud.xyz[i];
        const double azimuth = degrees(std::atan2(p.y(), p.x()));
        return azimuth < 1.2 && azimuth > -1.2;
    });
    const FeatureVector f = featuresOf(cut, cut.returnsOn(0));
    const FeatureVector without_hole = featuresOf(whole, whole.returnsOn(0));
    for (const Feature k :
         {Feature::GapShare, Feature::GapFree, Feature::GapHidden, Feature::Fill, Feature::Length, Feature::RingShare})
        EXPECT_NEAR(of(f, k), of(without_hole, k), 0.02f) << featureInfos()[static_cast<std::size_t>(k)].name;
}

TEST(Evidence, TwoCarsBesideEachOtherHaveANotch) {
    const Scan scan = scanOf({carAt(7.0, 7.2, 90.0), carAt(9.3, 7.2, 90.0)});
    const FeatureVector both = featuresOf(scan, returnsOnAll(scan, {0, 1}));
    EXPECT_GT(of(both, Feature::NotchDepth), 0.25f);
    EXPECT_GT(of(both, Feature::NotchRings), 0.3f);
    for (const int car : {0, 1}) {
        const FeatureVector one = featuresOf(scan, scan.returnsOn(car));
        EXPECT_LT(of(one, Feature::NotchDepth), 0.2f);
        EXPECT_EQ(of(one, Feature::NotchRings), 0.0f);
    }
}

/// Every feature of groups that are hardly any: all finite.
void expectFinite(const Scan& scan, const std::vector<std::int32_t>& points) {
    const FeatureVector f = featuresOf(scan, points);
    for (std::size_t k = 0; k < kFeatures; ++k)
        EXPECT_TRUE(std::isfinite(f[k])) << featureInfos()[k].name << " of " << points.size() << " returns";
}

TEST(DegenerateGroups, HaveFiniteFeatures) {
    const Scan scan = castRays(street(), Sensor{});
    const auto car = scan.returnsOn(0);
    expectFinite(scan, {car[0]});
    expectFinite(scan, {car[0], car[1]});
    expectFinite(scan, {car.front(), car.back()});
    expectFinite(scan, {car[0], car[0], car[0]});
    expectFinite(scan, scan.returnsOn(kOnGround));
    expectFinite(scan, allReturns(scan.cloud));
}

TEST(DegenerateGroups, AVerticalPoleIsThinHighAndFinite) {
    const Scan scan = scanOf({boxAt(6.0, 0.0, 0.0, {0.04, 0.04, 3.0})});
    const auto pole = scan.returnsOn(0);
    ASSERT_GE(pole.size(), 8u);
    expectFinite(scan, pole);
    const FeatureVector f = featuresOf(scan, pole);
    EXPECT_LT(of(f, Feature::Length), 0.08f);
    EXPECT_GT(of(f, Feature::Top), 2.5f);
    EXPECT_NEAR(of(f, Feature::RingShare), 1.0, 0.1);
}

TEST(DegenerateGroups, ScansOfOneRingAndOfOneReturnAreServed) {
    const Scan one_ring = castRays(street(), fewPlanes(1));
    expectFinite(one_ring, one_ring.returnsOn(0));
    const Scan all = castRays(street(), Sensor{});
    const std::int32_t kept = all.returnsOn(0)[0];
    const Scan alone = without(all, [&](std::int32_t i) { return i != kept; });
    expectFinite(alone, {0});
}

TEST(FeatureExtractor, MeasuresAGroupTheSameWhateverItMeasuredBefore) {
    const Scan scan = castRays(street(), Sensor{});
    const GroundModel ground = knownGround(scan);
    const Beams beams(scan.cloud);
    FeatureExtractor busy(beams, ground);
    const auto measure = [&](FeatureExtractor& extractor, int object) {
        const Hypothesis h = hypothesisOf(scan.returnsOn(object));
        return extractor(h, footprintOf(h.points, scan.cloud));
    };
    for (const int object : {8, 3, 2}) measure(busy, object);
    const FeatureVector after = measure(busy, 0);
    FeatureExtractor fresh(beams, ground);
    EXPECT_EQ(after, measure(fresh, 0));
    EXPECT_EQ(measure(busy, 0), after);
}

}  // namespace
}  // namespace lidar_obstacles
