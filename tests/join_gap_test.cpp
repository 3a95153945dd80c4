// SPDX-License-Identifier: BSD-3-Clause
// The shortest way between two groups of returns, seen from above.
#include "objects/join_gap.h"

#include <gtest/gtest.h>

#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// Outline of a rectangle, a return every 5 cm.
std::vector<Eigen::Vector3f> rectangle(double x, double y, double length, double width) {
    std::vector<Eigen::Vector3f> points;
    const auto add = [&](double u, double v) {
        points.emplace_back(static_cast<float>(x + u), static_cast<float>(y + v), 1.0f);
    };
    for (double s = -0.5; s <= 0.5 + 1e-9; s += 0.05 / std::max(length, width)) {
        for (const double side : {-0.5, 0.5}) {
            add(s * length, side * width);
            add(side * length, s * width);
        }
    }
    return points;
}

/// Two groups in one cloud.
struct Two {
    PointCloud cloud = cloudOf({});
    std::vector<std::int32_t> a;
    std::vector<std::int32_t> b;

    Two(const std::vector<Eigen::Vector3f>& first, const std::vector<Eigen::Vector3f>& second) {
        for (const auto* points : {&first, &second})
            for (const Eigen::Vector3f& p : *points) {
                (points == &first ? a : b).push_back(static_cast<std::int32_t>(cloud.size()));
                cloud.xyz.push_back(p);
            }
    }
    Gap gap() const { return gapBetween(footprintOf(a, cloud), footprintOf(b, cloud)); }
    Gap back() const { return gapBetween(footprintOf(b, cloud), footprintOf(a, cloud)); }
};

TEST(GapBetween, TwoReturnsAreAsFarApartAsTheyAre) {
    const Two two({{10.0f, 1.0f, 0.2f}}, {{13.0f, 5.0f, 2.0f}});
    const Gap gap = two.gap();
    EXPECT_EQ(gap.from, 0);
    EXPECT_EQ(gap.to, 1);
    EXPECT_NEAR(gap.length, 5.0f, 1e-5f) << "heights do not count";
}

TEST(GapBetween, ItsEndsAreReturnsOfTheTwoAndItsLengthIsTheirs) {
    const Two two(rectangle(10.0, 0.0, 4.5, 1.8), rectangle(12.0, 4.0, 1.0, 1.0));
    const Gap gap = two.gap();
    EXPECT_EQ(std::count(two.a.begin(), two.a.end(), gap.from), 1);
    EXPECT_EQ(std::count(two.b.begin(), two.b.end(), gap.to), 1);
    EXPECT_NEAR(gap.length, (two.cloud.xyz[gap.from] - two.cloud.xyz[gap.to]).head<2>().norm(), 1e-5f);
}

TEST(GapBetween, CornersThatFaceEachOtherGiveTheTrueGap) {
    // corners at (12, 1) and (13, 2): the outermost returns of a rectangle in sixteen directions hold all its corners
    const Two two(rectangle(10.0, 0.0, 4.0, 2.0), rectangle(15.0, 3.0, 4.0, 2.0));
    EXPECT_NEAR(two.gap().length, std::sqrt(2.0f), 1e-4f);
}

TEST(GapBetween, IsTheSameFromEitherSide) {
    const Two two(rectangle(10.0, 0.0, 4.5, 1.8), rectangle(11.0, 3.3, 0.5, 0.5));
    EXPECT_NEAR(two.gap().length, two.back().length, 1e-5f);
    EXPECT_EQ(two.gap().from, two.back().to);
    EXPECT_EQ(two.gap().to, two.back().from);
}

TEST(GapBetween, IsNeverShorterThanTheTrueGap) {
    for (double y = 2.0; y <= 6.0; y += 0.5) {
        const Two two(rectangle(10.0, 0.0, 4.5, 1.8), rectangle(9.0, y, 2.0, 0.6));
        EXPECT_GE(two.gap().length, y - 0.3 - 0.9 - 1e-4) << y;
    }
}

}  // namespace
}  // namespace lidar_obstacles
