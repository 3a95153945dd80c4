// SPDX-License-Identifier: BSD-3-Clause
// The vehicle's own body: as text, as a mask, and learnt from scans.
#include "lidar_obstacles/own_body.h"

#include <gtest/gtest.h>

#include <random>

#include "lidar_obstacles/own_body_learner.h"
#include "lidar_obstacles/params.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

TEST(OwnBody, ABoxHoldsWhatLiesInItAtItsHeights) {
    const OwnBody any("box(-1.5, 3, -1, 1)");
    EXPECT_TRUE(any.holds({2.9F, 0.9F, 40.F}));
    EXPECT_TRUE(any.holds({-1.5F, -1.F, -40.F})) << "the lower bounds belong to it";
    EXPECT_FALSE(any.holds({3.F, 0.F, 0.F})) << "the upper ones do not";
    EXPECT_FALSE(any.holds({0.F, 1.1F, 0.F}));
    const OwnBody low("box(-1.5, 3, -1, 1, 0, 1.2)");
    EXPECT_TRUE(low.holds({0.F, 0.F, 1.1F}));
    EXPECT_FALSE(low.holds({0.F, 0.F, 1.3F}));
}

TEST(OwnBody, APolygonNeedNotBeConvex) {
    const OwnBody u("polygon(0 0, 4 0, 4 3, 3 3, 3 1, 1 1, 1 3, 0 3)");  // a fork lift: two arms
    EXPECT_TRUE(u.holds({0.5F, 2.F, 0.F}));
    EXPECT_TRUE(u.holds({3.5F, 2.F, 0.F}));
    EXPECT_TRUE(u.holds({2.F, 0.5F, 0.F}));
    EXPECT_FALSE(u.holds({2.F, 2.F, 0.F})) << "between the arms";
}

TEST(OwnBody, SeveralPartsInARowAndNone) {
    const OwnBody body("box(0, 1, 0, 1)  polygon(5 5, 6 5, 5 6)");
    EXPECT_EQ(body.parts().size(), 2U);
    EXPECT_TRUE(body.holds({0.5F, 0.5F, 0.F}));
    EXPECT_TRUE(body.holds({5.2F, 5.2F, 0.F}));
    EXPECT_FALSE(body.holds({3.F, 3.F, 0.F}));
    EXPECT_TRUE(OwnBody("none").empty());
    EXPECT_FALSE(OwnBody("none").holds({0.F, 0.F, 0.F}));
    EXPECT_FALSE(OwnBody().holds({0.F, 0.F, 0.F}));
}

TEST(OwnBody, ItsTextReadsBackTheSame) {
    for (const char* text : {"none", "box(-1, 1, -0.6, 0.6)", "box(-1, 1, -0.6, 0.6, 0.1, 1.7)",
                             "polygon(0 0, 1 0.25, 0.5 3) box(2, 3, 4, 5)"})
        EXPECT_EQ(toText(OwnBody(text)), text);
}

TEST(OwnBody, WhatIsNotRightIsSaid) {
    for (const char* text : {"", "box", "box(1, 2, 3)", "box(2, 1, 0, 1)", "polygon(0 0, 1 1)", "polygon(0 0, 1 1, 2)",
                             "circle(0, 0, 1)", "box(0, 1, 0, x)", "box(0, 1, 0, 1) and more", "box(0, 1, 0, nan)"}) {
        EXPECT_THROW(OwnBody{std::string(text)}, std::invalid_argument) << text;
        DetectorParams params;
        params.region.own_body = text;
        EXPECT_THROW(validate(params), std::invalid_argument) << text;
    }
}

/// What is not ground of scans along a street of poles; the vehicle carries a rack and sees its hood.
struct Drive {
    explicit Drive(double metres_per_scan) {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> along(-30.0, 90.0), size(0.3, 3.0);
        World street;
        for (int k = 0; k < 120; ++k) {
            OrientedBox box;
            box.size = {size(random), size(random), 2.0};
            box.center = {along(random), (k % 2 == 0 ? 1.0 : -1.0) * (5.0 + 3.0 * size(random)), 1.0};
            street.boxes.push_back(box);
        }
        OrientedBox rack;
        rack.size = {0.4, 1.0, 0.3};
        rack.center = {-1.6, 0.0, 1.7};
        OrientedBox hood;
        hood.size = {0.8, 1.4, 0.8};
        hood.center = {1.9, 0.2, 0.8};
        for (int scan = 0; scan < 40; ++scan) {
            World world = street;
            for (OrientedBox& box : world.boxes) box.center.x() -= metres_per_scan * scan;
            world.boxes.insert(world.boxes.end(), {rack, hood});
            Sensor sensor;
            sensor.noise = 0.02;
            sensor.columns = 900;
            const Scan cast = castRays(world, sensor);
            std::vector<std::int32_t> returns;
            for (std::size_t i = 0; i < cast.cloud.size(); ++i)
                if (cast.hit[i] != kOnGround) returns.push_back(static_cast<std::int32_t>(i));
            learner.add(cast.cloud, returns);
            last = cast;
        }
        of_body = {static_cast<int>(street.boxes.size()), static_cast<int>(street.boxes.size()) + 1};
    }

    OwnBodyLearner learner;
    Scan last;
    std::vector<int> of_body;
};

TEST(OwnBodyLearner, WhatTheVehicleCarriesIsLearntAndNothingElse) {
    const Drive drive(1.0);
    ASSERT_TRUE(drive.learner.moved());
    const OwnBody body = drive.learner.learnt();
    ASSERT_FALSE(body.empty());
    std::size_t own = 0, masked = 0, others = 0;
    for (std::size_t i = 0; i < drive.last.cloud.size(); ++i) {
        const bool is_own = drive.last.hit[i] == drive.of_body[0] || drive.last.hit[i] == drive.of_body[1];
        const bool held = body.holds(drive.last.cloud.xyz[i]);
        own += is_own;
        masked += is_own && held;
        others += !is_own && held;
    }
    EXPECT_GT(own, 100U);
    EXPECT_EQ(masked, own);
    EXPECT_EQ(others, 0U);
}

TEST(OwnBodyLearner, AVehicleThatStandsLearnsNothing) {
    const Drive drive(0.0);
    EXPECT_FALSE(drive.learner.moved());
    EXPECT_TRUE(drive.learner.learnt().empty()) << "all of the world stays in place";
}

TEST(OwnBodyLearner, AFewScansAreNoEvidence) {
    OwnBodyLearner learner;
    for (int k = 0; k < 19; ++k) learner.add(PointCloud{}, {});
    EXPECT_FALSE(learner.moved());
    EXPECT_TRUE(learner.learnt().empty());
}

}  // namespace
}  // namespace lidar_obstacles
