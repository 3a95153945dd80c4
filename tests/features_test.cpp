// SPDX-License-Identifier: BSD-3-Clause
// What is measured of a group: sizes, heights, profile, rings, surface. Truth comes from the built scene.
#include "lidar_obstacles/feature_extractor.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "support/feature_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr double kBeam = 2.0 * M_PI / 1800.0;  // between neighbouring beams of a ring [rad]
constexpr double kRing = 2.0 * M_PI / 180.0;   // between rings [rad]

TEST(FeatureInfos, EachHasANameOfItsOwnAndAText) {
    std::set<std::string> names;
    for (const FeatureInfo& info : featureInfos()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_STRNE(info.text, "") << info.name;
    }
    EXPECT_STREQ(featureInfos()[static_cast<std::size_t>(Feature::GoesOnMore)].name, "goes_on_more");
    EXPECT_STREQ(featureInfos()[static_cast<std::size_t>(Feature::Noise)].name, "noise");
    EXPECT_STREQ(featureInfos()[static_cast<std::size_t>(Feature::LessStructure)].name, "less_structure");
    EXPECT_STREQ(featureInfos()[static_cast<std::size_t>(Feature::ToldMixture)].name, "told_mixture");
    EXPECT_STREQ(featureInfos()[static_cast<std::size_t>(Feature::AboutCount)].name, "about_count");
    EXPECT_STREQ(featureInfos().back().name, "person_size");
}

TEST(Features, OfNoReturnsAreZero) {
    const FeatureVector none{};
    EXPECT_EQ(featuresOf(scanOf({}), std::vector<std::int32_t>{}), none);
}

TEST(Features, AWallAcrossTheViewHasItsSizeAndLiesAcross) {
    const Scan scan = scanOf({wallAt(8.0, -1.5, 1.5, 0.0, 2.0)});
    const FeatureVector f = featuresOf(scan, scan.returnsOn(0));
    EXPECT_FLOAT_EQ(of(f, Feature::Returns), std::log2(static_cast<float>(scan.returnsOn(0).size())));
    EXPECT_NEAR(of(f, Feature::Range), 8.0, 0.01);
    EXPECT_NEAR(of(f, Feature::Length), 3.0, 2.0 * 8.2 * kBeam) << "a beam at either end";
    EXPECT_NEAR(of(f, Feature::Width), 0.0, 1e-3);
    EXPECT_NEAR(of(f, Feature::Facing), 1.0, 0.01);
    EXPECT_NEAR(of(f, Feature::Thickness), 0.0, 1e-3);
}

TEST(Features, AWallAlongTheLineOfSightIsNotFacing) {
    const FeatureVector f = featuresOf({boxAt(10.0, 1.0, 0.0, {4.0, 0.05, 2.0})});
    EXPECT_NEAR(of(f, Feature::Facing), std::sin(std::atan2(1.0, 10.0)), 0.03);
    EXPECT_NEAR(of(f, Feature::Length), 4.0, 0.4) << "beams meet it at 6 deg: 0.3 m apart";
}

TEST(Features, TheThicknessOfARightAngleIsAHalf) {
    // two sides of length 1 at 45 deg to the view: variances of 1/6 across and 1/24 along
    const FeatureVector f = featuresOf({boxAt(10.0, 0.0, 45.0, {1.0, 1.0, 2.0})});
    EXPECT_NEAR(of(f, Feature::Thickness), 0.5, 0.04);
}

TEST(Features, ReturnsOnTheSidesTowardsTheSensorAreNearThemAndThoseBehindAreFar) {
    const FeatureVector face = featuresOf({wallAt(9.0, -1.5, 1.5, 0.0, 2.0)});
    EXPECT_NEAR(of(face, Feature::EdgeMean), 0.0, 1e-3);
    EXPECT_NEAR(of(face, Feature::EdgeHigh), 0.0, 1e-3);
    // the far sides of a square yard, 3 m wide
    const std::vector<OrientedBox> boxes = {wallAt(12.0, -1.5, 1.5, 0.0, 2.0), wallAt(9.0, -1.5, -1.4, 0.0, 2.0),
                                            wallAt(9.0, 1.4, 1.5, 0.0, 2.0)};
    const Scan scan = scanOf(boxes);
    EXPECT_GT(of(featuresOf(scan, returnsOnAll(scan, {0, 1, 2})), Feature::EdgeMean), 0.5f);
}

TEST(Features, HeightsAreThoseOfTheReturns) {
    const Scan scan = scanOf({wallAt(8.0, -1.0, 1.0, 0.0, 1.0)});
    double low = 10.0;
    double high = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (const std::int32_t i : scan.returnsOn(0)) {
        const double z = scan.cloud.xyz[i].z();
        low = std::min(low, z);
        high = std::max(high, z);
        sum += z;
        squares += z * z;
    }
    const auto n = static_cast<double>(scan.returnsOn(0).size());
    const FeatureVector f = featuresOf(scan, scan.returnsOn(0));
    EXPECT_NEAR(of(f, Feature::Bottom), low, 1e-5);
    EXPECT_NEAR(of(f, Feature::Top), high, 1e-5);
    EXPECT_NEAR(of(f, Feature::MeanHeight), sum / n, 1e-4);
    EXPECT_NEAR(of(f, Feature::HeightSpread), std::sqrt(squares / n - sum * sum / (n * n)), 1e-3);
}

TEST(Features, TheTrueTopLiesBetweenTopAndTopLimit) {
    for (double x = 5.0; x <= 20.0; x += 1.0)
        for (const double height : {0.8, 1.2, 1.7}) {
            const FeatureVector f = featuresOf({wallAt(x, -1.0, 1.0, 0.0, height)});
            EXPECT_LE(of(f, Feature::Top), height + 1e-4) << x;
            EXPECT_GE(of(f, Feature::TopLimit), height - 0.01) << x;
            EXPECT_LE(of(f, Feature::TopLimit), height + 1.1 * x * kRing) << x;
        }
}

TEST(Features, TheTopIsFollowedBeyondTheGroup) {
    const Scan scan = scanOf({wallAt(10.0, -1.0, 1.0, 0.0, 6.0)});
    const auto low = returnsWhere(scan, 0, [](const Eigen::Vector3f& p) { return p.z() < 2.5f; });
    EXPECT_NEAR(of(featuresOf(scan, low), Feature::Top), 1.8 + 10.0 * std::tan(radians(15.0)), 0.05);
}

TEST(Features, WhatTheHighestRingHitMayBeOfAnyHeight) {
    const FeatureVector f = featuresOf({wallAt(10.0, -1.0, 1.0, 0.0, 6.0)});
    EXPECT_EQ(of(f, Feature::TopLimit), 10.0f) << "10 m at most";
}

TEST(Features, SharesOfTheHeightsAreCounted) {
    const Scan scan = scanOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.4)});
    const FeatureVector f = featuresOf(scan, scan.returnsOn(0));
    const auto share = [&](double from, double to) {
        const auto in = returnsWhere(scan, 0, [&](const Eigen::Vector3f& p) { return p.z() >= from && p.z() < to; });
        return static_cast<double>(in.size()) / static_cast<double>(scan.returnsOn(0).size());
    };
    EXPECT_NEAR(of(f, Feature::ShareKnee), share(0.0, 0.4), 1e-5);
    EXPECT_NEAR(of(f, Feature::ShareHip), share(0.4, 0.9), 1e-5);
    EXPECT_NEAR(of(f, Feature::ShareChest), share(0.9, 1.4), 1e-5);
    EXPECT_NEAR(of(f, Feature::ShareHead), share(1.4, 1.9), 1e-5);
    EXPECT_NEAR(of(f, Feature::ShareAbove), share(1.9, 3.0), 1e-5);
    EXPECT_GT(of(f, Feature::ShareAbove), 0.0f);
}

TEST(Features, ASignOnAPostIsNarrowBelowAndWideAbove) {
    const Scan scan = scanOf({wallAt(6.0, -0.1, 0.1, 0.0, 1.2), wallAt(6.0, -0.8, 0.8, 1.2, 2.0)});
    const FeatureVector f = featuresOf(scan, returnsOnAll(scan, {0, 1}));
    EXPECT_NEAR(of(f, Feature::WidthLow), 0.2 / 1.6, 0.03);
    EXPECT_NEAR(of(f, Feature::WidthHigh), 1.0, 0.03);
    EXPECT_GT(of(f, Feature::RingWidthSpread), 0.5f);
    const FeatureVector wall = featuresOf({wallAt(6.0, -0.8, 0.8, 0.0, 2.0)});
    EXPECT_NEAR(of(wall, Feature::WidthLow), 1.0, 0.03);
    EXPECT_NEAR(of(wall, Feature::WidthMiddle), 1.0, 0.03);
    EXPECT_NEAR(of(wall, Feature::RingWidthSpread), 0.0, 0.01);
}

TEST(Features, WhatLeansBackIsFartherAbove) {
    const Scan scan = scanOf({wallAt(8.0, -1.0, 1.0, 0.0, 0.9), wallAt(9.0, -1.0, 1.0, 0.0, 2.4)});
    // lower third of .24 .. 2.3 m: all on the near wall; upper third: all on the far one
    EXPECT_NEAR(of(featuresOf(scan, returnsOnAll(scan, {0, 1})), Feature::Lean), 1.0, 0.05);
    EXPECT_NEAR(of(featuresOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0)}), Feature::Lean), 0.0, 0.02);
}

TEST(Features, RingsAreCountedAgainstTheRoomThatTheHeightHas) {
    const Scan scan = scanOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0)});
    const auto all = scan.returnsOn(0);
    const FeatureVector f = featuresOf(scan, all);
    EXPECT_EQ(of(f, Feature::Rings), 7.0f) << "-11 .. 1 deg";
    EXPECT_NEAR(of(f, Feature::RingShare), 1.0, 0.05);
    std::vector<std::int32_t> odd;
    for (const std::int32_t i : all)
        if (scan.cloud.ring[i] % 2 == 0) odd.push_back(i);
    const FeatureVector half = featuresOf(scan, odd);
    EXPECT_EQ(of(half, Feature::Rings), 4.0f);
    EXPECT_NEAR(of(half, Feature::RingShare), 4.0 / 7.0, 0.05);
}

TEST(Features, TheFillIsTheShareOfTheBeamsOfEachRingThatHit) {
    const Scan scan = scanOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0)});
    std::vector<std::int32_t> every_fourth;
    for (const std::int32_t i : scan.returnsOn(0))
        if (scan.cloud.view.column_of[i] % 4 == 0) every_fourth.push_back(i);
    EXPECT_EQ(of(featuresOf(scan, scan.returnsOn(0)), Feature::Fill), 1.0f);
    EXPECT_NEAR(of(featuresOf(scan, every_fourth), Feature::Fill), 0.25, 0.02);
}

TEST(Features, AWallIsSmoothAndAThicketIsRough) {
    Sensor sensor;
    sensor.noise = 0.02;
    const Scan wall = scanOf({wallAt(8.0, -2.0, 2.0, 0.0, 2.0)}, sensor);
    const FeatureVector f = featuresOf(wall, wall.returnsOn(0));
    // .674 of a deviation, times sqrt(1.5), over a noise that is known to 30 %
    EXPECT_NEAR(of(f, Feature::RoughMetres), 0.674 * std::sqrt(1.5) * 0.02, 0.003);
    EXPECT_NEAR(of(f, Feature::RoughMedian), 0.825, 0.3);
    EXPECT_NEAR(of(f, Feature::Noise), 0.02, 0.006);
    EXPECT_GT(of(f, Feature::RoughHigh), of(f, Feature::RoughMedian));
    std::vector<OrientedBox> twigs;
    std::vector<int> numbers;
    cv::RNG random(2);
    for (int k = 0; k < 120; ++k) {
        twigs.push_back(boxAt(8.0 + random.uniform(0.0, 0.25), random.uniform(-1.0, 1.0), 0.0, {0.02, 0.04, 2.0}));
        numbers.push_back(k);
    }
    const Scan thicket = scanOf(twigs, sensor);
    EXPECT_GT(of(featuresOf(thicket, returnsOnAll(thicket, numbers)), Feature::RoughMetres), 0.025f);
}

TEST(Features, RangesJumpWhereThingsStandOneBehindTheOther) {
    EXPECT_EQ(of(featuresOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0)}), Feature::Jumps), 0.0f);
    const Scan scan = scanOf({wallAt(8.0, -1.0, 0.0, 0.0, 2.0), wallAt(9.5, 0.0, 1.2, 0.0, 2.0)});
    const auto both = returnsOnAll(scan, {0, 1});
    const FeatureVector f = featuresOf(scan, both);
    // one jump in each of the seven rings, of all pairs of neighbours; of more than 256 returns every k-th is looked at
    EXPECT_GT(of(f, Feature::Jumps), 0.0f);
    EXPECT_LT(of(f, Feature::Jumps), 4.0f * 7.0f / static_cast<float>(both.size()));
}

TEST(Features, AWallRisesSteeplyAndARampDoesNot) {
    EXPECT_EQ(of(featuresOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0)}), Feature::Steep), 1.0f);
    World world = flatWorld();
    world.ground[0].x_max = 6.0;
    GroundStrip ramp;
    ramp.slope.x() = std::tan(radians(20.0));
    ramp.offset = -6.0 * ramp.slope.x();
    ramp.x_min = 6.0;
    world.ground.push_back(ramp);
    const Scan scan = castRays(world, Sensor{});
    const auto on_ramp =
        returnsWhere(scan, kOnGround, [](const Eigen::Vector3f& p) { return p.x() > 6.1f && std::abs(p.y()) < 1.0f; });
    ASSERT_GT(on_ramp.size(), 100u);
    EXPECT_EQ(of(featuresOf(scan, on_ramp), Feature::Steep), 0.0f);
}

TEST(Features, WhatTheTreeKnowsIsHandedOn) {
    const Scan scan = scanOf({wallAt(8.0, -1.0, 1.0, 0.0, 2.0)});
    Hypothesis h = hypothesisOf(scan.returnsOn(0));
    h.gap = 0.4f;
    h.next_gap = 1.3f;
    h.pieces = 3;
    const FeatureVector f = featuresOf(scan, h);
    EXPECT_EQ(of(f, Feature::Gap), 0.4f);
    EXPECT_EQ(of(f, Feature::NextGap), 1.3f);
    EXPECT_EQ(of(f, Feature::Pieces), 3.0f);
    h.pieces = 40;
    EXPECT_EQ(of(featuresOf(scan, h), Feature::Pieces), 16.0f);
}

TEST(Features, StepsAndTheSensorsHeightAreThoseOfTheScan) {
    Sensor sensor;
    sensor.position = {1.0, 0.5, 2.4};
    const FeatureVector f = featuresOf({wallAt(9.0, -1.0, 1.0, 0.0, 2.0)}, sensor);
    EXPECT_NEAR(of(f, Feature::SensorHeight), 2.4, 1e-4);
    EXPECT_NEAR(of(f, Feature::Range), 8.0, 0.02);
    EXPECT_NEAR(of(f, Feature::BeamStep), 8.0 * kBeam, 1e-3);
    EXPECT_NEAR(of(f, Feature::RingStep), 8.0 * kRing, 0.01);
}

}  // namespace
}  // namespace lidar_obstacles
