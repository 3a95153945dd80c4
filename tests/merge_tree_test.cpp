// SPDX-License-Identifier: BSD-3-Clause
// What may be one object: pieces joined nearest first.
#include "objects/merge_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/feature_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// A scan and one piece per box of its world.
struct Pieces {
    Scan scan;
    Beams beams;
    std::vector<Cluster> pieces;

    explicit Pieces(const std::vector<OrientedBox>& boxes, const Sensor& sensor = {})
        : scan(scanOf(boxes, sensor)), beams(scan.cloud) {
        for (int b = 0; b < static_cast<int>(boxes.size()); ++b) {
            pieces.emplace_back();
            pieces.back().points = scan.returnsOn(b);
        }
    }
    std::vector<Hypothesis> tree(const GroupingParams& params = {}) const {
        return mergeTree(pieces, beams, params).hypotheses;
    }
};

/// Posts 20 cm wide across the view at these places.
std::vector<OrientedBox> postsAt(double x, const std::vector<double>& places) {
    std::vector<OrientedBox> posts;
    for (const double y : places) posts.push_back(wallAt(x, y - 0.1, y + 0.1, 0.0, 2.0));
    return posts;
}

TEST(MergeTree, NoPiecesGiveNoHypotheses) {
    const Scan scan = scanOf({});
    EXPECT_TRUE(mergeTree({}, Beams(scan.cloud), GroupingParams{}).hypotheses.empty());
}

TEST(MergeTree, ThePiecesComeFirstInTheirOrder) {
    const Pieces scene(postsAt(8.0, {-1.0, 0.0, 1.2}));
    const auto tree = scene.tree();
    ASSERT_GE(tree.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(tree[k].points, scene.pieces[k].points);
        EXPECT_EQ(tree[k].part[0], -1);
        EXPECT_EQ(tree[k].pieces, 1);
    }
}

TEST(MergeTree, TheNearestAreJoinedFirst) {
    // gaps of 0.8 m and 1.0 m
    Pieces scene(postsAt(8.0, {-1.0, 0.0, 1.2}));
    scene.pieces[0].hangs = true;
    const auto tree = scene.tree();
    ASSERT_EQ(tree.size(), 5u);
    EXPECT_EQ(tree[3].part, (std::array<int, 2>{0, 1}));
    EXPECT_EQ(tree[0].hanging, 1);
    EXPECT_EQ(tree[2].hanging, 0);
    EXPECT_EQ(tree[4].hanging, 1);
    EXPECT_NEAR(tree[3].gap, 0.8, 0.06) << "to the last beams on either post";
    EXPECT_EQ(tree[4].part, (std::array<int, 2>{3, 2}));
    EXPECT_NEAR(tree[4].gap, 1.0, 0.06);
    EXPECT_EQ(tree[4].pieces, 3);
    EXPECT_NEAR(tree[0].next_gap, 0.8, 0.06);
    EXPECT_NEAR(tree[2].next_gap, 1.0, 0.06);
    EXPECT_NEAR(tree[3].next_gap, 1.0, 0.06);
}

TEST(MergeTree, PartsStandBeforeWholesAndKnowThem) {
    const auto tree = Pieces(postsAt(8.0, {-2.0, -1.0, 0.0, 1.2, 1.8})).tree();
    for (int k = 0; k < static_cast<int>(tree.size()); ++k) {
        const Hypothesis& h = tree[static_cast<std::size_t>(k)];
        if (h.parent >= 0) {
            EXPECT_GT(h.parent, k);
            const auto& parts = tree[static_cast<std::size_t>(h.parent)].part;
            EXPECT_TRUE(parts[0] == k || parts[1] == k);
        }
        for (const int part : h.part)
            if (part >= 0) {
                EXPECT_LT(part, k);
                EXPECT_EQ(tree[static_cast<std::size_t>(part)].parent, k);
            }
    }
}

TEST(MergeTree, AWholeHoldsTheReturnsOfItsPartsAndNoOthers) {
    const auto tree = Pieces(postsAt(8.0, {-2.0, -1.0, 0.0, 1.2})).tree();
    for (const Hypothesis& h : tree) {
        if (h.part[0] < 0) continue;
        std::vector<std::int32_t> parts = tree[static_cast<std::size_t>(h.part[0])].points;
        const auto& other = tree[static_cast<std::size_t>(h.part[1])].points;
        parts.insert(parts.end(), other.begin(), other.end());
        std::vector<std::int32_t> whole = h.points;
        std::sort(parts.begin(), parts.end());
        std::sort(whole.begin(), whole.end());
        EXPECT_EQ(whole, parts);
        EXPECT_EQ(std::adjacent_find(whole.begin(), whole.end()), whole.end()) << "a return twice";
    }
}

TEST(MergeTree, PiecesFartherApartThanTheLimitAreNotJoined) {
    const Pieces scene(postsAt(8.0, {-1.0, 1.0}));  // a gap of 1.8 m
    GroupingParams params;
    params.max_gap = 2.0;
    EXPECT_EQ(scene.tree(params).size(), 3u);
    params.max_gap = 1.5;
    const auto apart = scene.tree(params);
    EXPECT_EQ(apart.size(), 2u);
    EXPECT_EQ(apart[0].next_gap, Hypothesis{}.next_gap);
}

TEST(MergeTree, AlongTheLineOfSightTwoThingsAreNearerThanAcrossIt) {
    // 2 m apart either way: a windscreen that leans by 22 deg leaves 0.4 of the way to be resolved
    const auto across = Pieces(postsAt(8.0, {-1.1, 1.1})).tree();
    std::vector<OrientedBox> boxes = postsAt(8.0, {0.0});
    boxes[0].size.z() = 1.0;
    boxes[0].center.z() = 0.5;
    boxes.push_back(postsAt(10.0, {0.0})[0]);
    const auto along = Pieces(boxes).tree();
    ASSERT_EQ(across.size(), 3u);
    ASSERT_EQ(along.size(), 3u);
    EXPECT_NEAR(across[2].gap, 2.0, 0.06);
    EXPECT_NEAR(along[2].gap, 0.4 * 2.0, 0.06);
}

TEST(MergeTree, WhatTogetherIsLargerThanAnyVehicleIsNotJoined) {
    std::vector<OrientedBox> walls = {wallAt(10.0, -4.0, -0.25, 0.0, 2.0), wallAt(10.0, 0.25, 4.0, 0.0, 2.0)};
    GroupingParams params;
    params.max_length = 8.5;
    EXPECT_EQ(Pieces(walls).tree(params).size(), 3u);
    params.max_length = 7.5;
    EXPECT_EQ(Pieces(walls).tree(params).size(), 2u);
    // a corner: 4 m along either side
    walls[1] = boxAt(7.9, -4.1, 0.0, {4.0, 0.1, 2.0});
    params = {};
    params.max_width = 4.2;
    EXPECT_EQ(Pieces(walls).tree(params).size(), 3u);
    params.max_width = 2.0;
    EXPECT_EQ(Pieces(walls).tree(params).size(), 2u);
}

TEST(MergeTree, EachHypothesisHasTheFootprintOfItsReturns) {
    const Pieces scene(postsAt(8.0, {-2.0, -1.0, 0.0, 1.2}));
    const MergeTree tree = mergeTree(scene.pieces, scene.beams, GroupingParams{});
    ASSERT_EQ(tree.footprints.size(), tree.hypotheses.size());
    for (std::size_t k = 0; k < tree.hypotheses.size(); ++k) {
        const Eigen::AlignedBox2f bounds = boundsOf(tree.hypotheses[k].points, scene.scan.cloud);
        EXPECT_EQ(tree.footprints[k].box.min(), bounds.min());
        EXPECT_EQ(tree.footprints[k].box.max(), bounds.max());
    }
}

TEST(LinkBetween, IsVeryLargeWhereBothTogetherFitNoVehicle) {
    const Pieces scene({wallAt(10.0, -12.0, -0.5, 0.0, 2.0), wallAt(10.0, 0.5, 12.0, 0.0, 2.0)});
    const Footprint a = footprintOf(scene.pieces[0].points, scene.scan.cloud);
    const Footprint b = footprintOf(scene.pieces[1].points, scene.scan.cloud);
    EXPECT_GT(linkBetween(a, b, scene.scan.cloud, GroupingParams{}), 1e6f);
    GroupingParams larger;
    larger.max_length = 30.0;
    EXPECT_NEAR(linkBetween(a, b, scene.scan.cloud, larger), 1.0, 0.1);
}

}  // namespace
}  // namespace lidar_obstacles
