// SPDX-License-Identifier: BSD-3-Clause
// What was thought of the parts of a group and of its neighbours, as features.
#include <gtest/gtest.h>

#include <cmath>

#include "objects/surroundings.h"
#include "support/feature_scene.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// A chosen group of so many returns in a square of 1 m about a place, with a probability of a category.
void add(MergeTree& tree, float x, float y, int returns, Category category, float probability) {
    Hypothesis h;
    h.points.resize(static_cast<std::size_t>(returns));
    h.category[static_cast<std::size_t>(category)] = probability;
    h.chosen = true;
    tree.hypotheses.push_back(h);
    Footprint f;
    f.box = {Eigen::Vector2f(x - 0.5f, y - 0.5f), Eigen::Vector2f(x + 0.5f, y + 0.5f)};
    tree.footprints.push_back(f);
    tree.features.emplace_back();
}

FeatureVector surroundingsOf(const MergeTree& tree, std::size_t k) {
    FeatureVector f{};
    Surroundings(tree).measure(k, f);
    return f;
}

TEST(Parts, APieceHasNone) {
    FeatureVector f{};
    Hypothesis piece;
    piece.points = {0, 1, 2};
    measureParts(piece, {}, f);
    for (Feature k : {Feature::Apart, Feature::LessShare, Feature::MoreWhole, Feature::LessStructure})
        EXPECT_EQ(of(f, k), -1.0f);
    EXPECT_EQ(of(f, Feature::Noise), 0.0f) << "what is measured stays";
    EXPECT_EQ(of(f, Feature::ToldUnknown), 0.0f);
}

TEST(Parts, TheOneWithMoreReturnsComesFirst) {
    std::vector<Hypothesis> tree(2);
    tree[0].points = {0};
    tree[0].whole = 0.2f;
    tree[0].cut = 0.2f;
    tree[0].probability[static_cast<std::size_t>(ObstacleClass::Cyclist)] = 0.7f;
    tree[1].points = {1, 2, 3};
    tree[1].whole = 0.9f;
    tree[1].cut = 2.8f;
    tree[1].probability[static_cast<std::size_t>(ObstacleClass::Vehicle)] = 0.6f;
    Hypothesis whole;
    whole.part = {0, 1};
    whole.points = {0, 1, 2, 3};
    FeatureVector f{};
    measureParts(whole, tree, f);
    EXPECT_FLOAT_EQ(of(f, Feature::Apart), 0.75f);
    EXPECT_FLOAT_EQ(of(f, Feature::LessShare), 0.25f);
    EXPECT_FLOAT_EQ(of(f, Feature::MoreWhole), 0.9f);
    EXPECT_FLOAT_EQ(of(f, Feature::MoreVehicle), 0.6f);
    EXPECT_FLOAT_EQ(of(f, Feature::LessWhole), 0.2f);
    EXPECT_FLOAT_EQ(of(f, Feature::LessPerson), 0.7f);
    std::swap(whole.part[0], whole.part[1]);
    FeatureVector swapped{};
    measureParts(whole, tree, swapped);
    EXPECT_EQ(swapped, f);
}

TEST(Surroundings, OfALoneGroupAreEmpty) {
    MergeTree tree;
    add(tree, 5.0f, 0.0f, 16, Category::Vehicle, 0.8f);
    add(tree, 30.0f, 0.0f, 16, Category::Structure, 1.0f);
    const FeatureVector f = surroundingsOf(tree, 0);
    EXPECT_FLOAT_EQ(of(f, Feature::ToldVehicle), 0.8f);
    EXPECT_EQ(of(f, Feature::AboutCount), 0.0f);
    EXPECT_EQ(of(f, Feature::AboutStructure), 0.0f);
    EXPECT_EQ(of(f, Feature::NextAway), 12.0f);
    EXPECT_EQ(of(f, Feature::StructureAway), 12.0f);
    EXPECT_EQ(of(f, Feature::StructureSize), 0.0f);
}

TEST(Surroundings, CountTheGroupsWithinEachRadius) {
    MergeTree tree;
    add(tree, 0.0f, 0.0f, 16, Category::Vehicle, 1.0f);
    add(tree, 0.0f, 1.5f, 9, Category::Structure, 1.0f);     // 0.5 m away
    add(tree, -3.0f, 0.0f, 4, Category::VehiclePart, 0.5f);  // 2 m away, before it along x
    add(tree, 8.0f, 0.0f, 64, Category::Cyclist, 0.75f);     // 7 m away
    const FeatureVector f = surroundingsOf(tree, 0);
    EXPECT_FLOAT_EQ(of(f, Feature::BesideStructure), 3.0f / 4.0f) << "weights are roots of returns, and 1 for doubt";
    EXPECT_FLOAT_EQ(of(f, Feature::NearStructure), 3.0f / 6.0f);
    EXPECT_FLOAT_EQ(of(f, Feature::NearVehicle), 1.0f / 6.0f);
    EXPECT_FLOAT_EQ(of(f, Feature::NearOther), 1.0f / 6.0f);
    EXPECT_FLOAT_EQ(of(f, Feature::AboutPerson), 6.0f / 14.0f);
    EXPECT_FLOAT_EQ(of(f, Feature::BesideCount), std::log(2.0f));
    EXPECT_FLOAT_EQ(of(f, Feature::AboutCount), std::log(4.0f));
    EXPECT_FLOAT_EQ(of(f, Feature::NextAway), 0.5f);
    EXPECT_FLOAT_EQ(of(f, Feature::NextStructure), 1.0f);
    EXPECT_FLOAT_EQ(of(f, Feature::PersonAway), 7.0f);
    EXPECT_FLOAT_EQ(of(f, Feature::PersonSize), 2.0f);
    EXPECT_EQ(of(f, Feature::VehicleAway), 12.0f) << "as likely a vehicle as not";
}

TEST(Surroundings, LeaveOutWhatWasNotChosen) {
    MergeTree tree;
    add(tree, 0.0f, 0.0f, 16, Category::Vehicle, 1.0f);
    add(tree, 0.0f, 1.5f, 9, Category::Structure, 1.0f);
    tree.hypotheses[1].chosen = false;
    EXPECT_EQ(of(surroundingsOf(tree, 0), Feature::AboutCount), 0.0f);
}

}  // namespace
}  // namespace lidar_obstacles
