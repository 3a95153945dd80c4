// SPDX-License-Identifier: BSD-3-Clause
// What earlier scans let expect: pieces parted at it, groups that are likelier whole, classes that are less in doubt.
#include "objects/expectations.h"

#include <gtest/gtest.h>

#include <set>

#include "objects/groups.h"
#include "support/feature_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

const OrientedBox kPerson{{7.6, 0.0, 0.9}, {0.5, 0.5, 1.8}, 0.0};
const OrientedBox kWall = wallAt(8.0, -4.0, 4.0, 0.0, 2.5);

ClassProbabilities surely(ObstacleClass cls) {
    ClassProbabilities p{};
    p.fill(0.01f);
    p[static_cast<std::size_t>(cls)] = 0.96f;
    return p;
}

ExpectedObject expectedAt(const OrientedBox& box, ObstacleClass cls) { return {box, 0.05, surely(cls)}; }

std::set<std::int32_t> setOf(const std::vector<std::int32_t>& points) { return {points.begin(), points.end()}; }

/// A person in front of a wall, seen as one piece.
struct PersonAtAWall {
    Scan scan = scanOf({kPerson, kWall});
    std::vector<Cluster> piece{Cluster{}};
    PersonAtAWall() { piece[0].points = returnsOnAll(scan, {0, 1}); }
};

TEST(PartedAtExpected, WhereNothingIsExpectedPiecesStayWhole) {
    const PersonAtAWall scene;
    const auto none = partedAtExpected(scene.piece, scene.scan.cloud, {});
    ASSERT_EQ(none.size(), 1u);
    EXPECT_EQ(none[0].points, scene.piece[0].points);
    const OrientedBox elsewhere{{-9.0, 3.0, 0.9}, {0.5, 0.5, 1.8}, 0.0};
    const auto far =
        partedAtExpected(scene.piece, scene.scan.cloud, {expectedAt(elsewhere, ObstacleClass::Pedestrian)});
    ASSERT_EQ(far.size(), 1u);
    EXPECT_EQ(far[0].points, scene.piece[0].points);
}

TEST(PartedAtExpected, APersonWhoWalkedUpToAWallIsAPieceOfHisOwn) {
    const PersonAtAWall scene;
    const auto parts =
        partedAtExpected(scene.piece, scene.scan.cloud, {expectedAt(kPerson, ObstacleClass::Pedestrian)});
    ASSERT_EQ(parts.size(), 2u);
    const std::set<std::int32_t> person = setOf(parts[0].points);
    for (const std::int32_t i : scene.scan.returnsOn(0)) EXPECT_TRUE(person.count(i)) << i;
    EXPECT_EQ(parts[0].points.size() + parts[1].points.size(), scene.piece[0].points.size());
    EXPECT_GT(parts[1].points.size(), 5 * parts[0].points.size());
}

TEST(PartedAtExpected, FewReturnsStayWithTheRest) {
    PersonAtAWall scene;
    scene.piece[0].points = scene.scan.returnsOn(1);
    std::vector<std::int32_t> person = scene.scan.returnsOn(0);
    person.resize(kSpeck - 1);
    scene.piece[0].points.insert(scene.piece[0].points.end(), person.begin(), person.end());
    OrientedBox tight = kPerson;
    tight.center.x() = 7.3;  // ends before the wall
    const auto parts = partedAtExpected(scene.piece, scene.scan.cloud, {expectedAt(tight, ObstacleClass::Pedestrian)});
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(setOf(parts[0].points), setOf(scene.piece[0].points));
}

/// Two halves of a car and the whole, with these probabilities of being whole.
MergeTree halvesOfACar(const Scan& scan, float half, float whole) {
    MergeTree tree;
    const auto left = [](const Eigen::Vector3f& p) { return p.y() > 0.0f; };
    const auto right = [](const Eigen::Vector3f& p) { return p.y() <= 0.0f; };
    tree.hypotheses = {hypothesisOf(returnsWhere(scan, 0, left)), hypothesisOf(returnsWhere(scan, 0, right)),
                       hypothesisOf(scan.returnsOn(0))};
    tree.hypotheses[2].part = {0, 1};
    for (const int k : {0, 1}) {
        tree.hypotheses[static_cast<std::size_t>(k)].parent = 2;
        tree.hypotheses[static_cast<std::size_t>(k)].whole = half;
    }
    tree.hypotheses[2].whole = whole;
    for (const Hypothesis& h : tree.hypotheses) tree.footprints.push_back(footprintOf(h.points, scan.cloud));
    return tree;
}

const OrientedBox kCar{{9.0, 0.0, 0.75}, {4.2, 1.8, 1.5}, 0.0};

TEST(LookForExpected, TheGroupOnTheReturnsOfABoxIsLikelierWhole) {
    const Scan scan = scanOf({kCar});
    MergeTree tree = halvesOfACar(scan, 0.5f, 0.5f);
    lookForExpected(tree, scan.cloud, {expectedAt(kCar, ObstacleClass::Vehicle)});
    EXPECT_NEAR(likelierWhole(tree.hypotheses[2]), 10.0f, 0.01f);
    EXPECT_LT(likelierWhole(tree.hypotheses[0]), 2.0f);
    EXPECT_LT(likelierWhole(tree.hypotheses[1]), 2.0f);
    EXPECT_EQ(tree.hypotheses[2].expected.inside, static_cast<int>(scan.returnsOn(0).size()));
}

TEST(LookForExpected, WhereNothingIsExpectedNothingChanges) {
    const Scan scan = scanOf({kCar});
    MergeTree tree = halvesOfACar(scan, 0.5f, 0.5f);
    OrientedBox beside = kCar;
    beside.center.y() = 4.0;
    lookForExpected(tree, scan.cloud, {expectedAt(beside, ObstacleClass::Vehicle)});
    const ClassProbabilities told = surely(ObstacleClass::Structure);
    for (const Hypothesis& h : tree.hypotheses) {
        EXPECT_EQ(likelierWhole(h), 1.0f);
        EXPECT_EQ(asExpected(told, h), told);
    }
}

TEST(LookForExpected, ACarThatIsFollowedStaysOneCar) {
    const Scan scan = scanOf({kCar});
    for (const bool followed : {false, true}) {
        MergeTree tree = halvesOfACar(scan, 0.6f, 0.4f);
        if (followed) lookForExpected(tree, scan.cloud, {expectedAt(kCar, ObstacleClass::Vehicle)});
        chooseBestCut(tree.hypotheses);
        EXPECT_EQ(tree.hypotheses[2].chosen, followed);
    }
}

TEST(AsExpected, WhatIsKnownOfTheObjectDecidesWhatIsInDoubt) {
    const Scan scan = scanOf({kCar});
    MergeTree tree = halvesOfACar(scan, 0.5f, 0.5f);
    lookForExpected(tree, scan.cloud, {expectedAt(kCar, ObstacleClass::Vehicle)});
    ClassProbabilities doubt{};
    doubt.fill(0.02f);
    doubt[static_cast<std::size_t>(ObstacleClass::Structure)] = 0.7f;
    doubt[static_cast<std::size_t>(ObstacleClass::Vehicle)] = 0.24f;
    const ClassProbabilities both = asExpected(doubt, tree.hypotheses[2]);
    EXPECT_GT(both[static_cast<std::size_t>(ObstacleClass::Vehicle)], 0.9f);
    float sum = 0.0f;
    for (const float p : both) sum += p;
    EXPECT_NEAR(sum, 1.0f, 1e-5f);
    // half of the returns are not what is expected
    EXPECT_GT(asExpected(doubt, tree.hypotheses[0])[static_cast<std::size_t>(ObstacleClass::Structure)], 0.5f);
}

}  // namespace
}  // namespace lidar_obstacles
