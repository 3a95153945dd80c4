// SPDX-License-Identifier: BSD-3-Clause
// How beams get into leaves.
#include <gtest/gtest.h>

#include <cmath>

#include "lidar_obstacles/simulation/material.h"
#include "support/small_worlds.h"

namespace lidar_obstacles::simulation {
namespace {

using test::scanOf;
using test::SmallWorld;
using test::worldOf;

/// A hedge 8 m to the left, a wall 6 m behind it.
struct Hedge {
    double depth = 0.0;  ///< mean, behind the mean place of the nearest returns [m]
    double through = 0.0;
    int hedge = 0;
};

Hedge hedgeOf(const std::string& leaves) {
    SmallWorld small;
    small.lists =
        "clutter: [{type: hedge, from: 90, to: 110, d: 8, width: 1, height: 4, roughness: 0.01, leaves: " + leaves +
        "}, {type: wall, from: 60, to: 140, d: 14, height: 8}]\n";
    Hedge result;
    int behind = 0;
    for (const LidarReturn& r : scanOf(worldOf(small)).returns) {
        const bool window = std::abs(r.point.x()) < 4.0f && r.point.z() > 0.5f && r.point.z() < 3.0f;
        if (!window || r.point.y() < 0.0f) continue;
        if (r.kind == ObjectKind::Wall) ++behind;
        if (r.kind != ObjectKind::Hedge) continue;
        ++result.hedge;
        result.depth += r.point.y() - 7.5;
    }
    result.depth /= result.hedge;
    result.through = static_cast<double>(behind) / (behind + result.hedge);
    return result;
}

TEST(Leaves, LetBeamsInAsDeepAsWasAskedFor) {
    const Hedge trimmed = hedgeOf("0.02"), loose = hedgeOf("0.15");
    EXPECT_NEAR(trimmed.depth, 0.03, 0.03);
    EXPECT_NEAR(loose.depth, 0.17, 0.06);
    EXPECT_GT(trimmed.hedge, 500);
    EXPECT_LT(trimmed.through, 0.01);
}

TEST(Leaves, OpenOnesLetManyBeamsThrough) {
    const double half = hedgeOf("0.7").through, most = hedgeOf("1.5").through;
    EXPECT_GT(half, 0.1);
    EXPECT_LT(half, 0.6);
    EXPECT_GT(most, half + 0.1);
}

TEST(Leaves, MaterialsAreNearWhatWasAskedFor) {
    for (double path : {0.01, 0.03, 0.1, 0.4, 1.2}) EXPECT_NEAR(opticsOf(leaves(path)).free_path / path, 1.0, 0.2);
    EXPECT_DOUBLE_EQ(opticsOf(leaves(0.0001)).free_path, 0.01) << "there is none denser";
}

TEST(Dropout, LosesTheShareThatWasAskedFor) {
    const auto returns = [](const std::string& sensor) {
        SmallWorld small;
        small.lists = "clutter: [{type: wall, from: 50, to: 200, d: -14, height: 4}]\n";
        small.sensor = sensor;
        return static_cast<double>(scanOf(worldOf(small)).returns.size());
    };
    EXPECT_NEAR(returns(", dropout: 0.2") / returns(""), 0.8, 0.02);
}

}  // namespace
}  // namespace lidar_obstacles::simulation
