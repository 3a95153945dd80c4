// SPDX-License-Identifier: BSD-3-Clause
// What a group is: probabilities worked out by hand, what the training has not seen, sizes, and bad model files.
#include "lidar_obstacles/recognizer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <string>

#include "support/size_model.h"

namespace lidar_obstacles {
namespace {

using namespace test;

float& at(FeatureVector& f, Feature k) { return f[static_cast<std::size_t>(k)]; }
float of(const CategoryProbabilities& p, Category c) { return p[static_cast<std::size_t>(c)]; }
float of(const ClassProbabilities& p, ObstacleClass c) { return p[static_cast<std::size_t>(c)]; }

/// A thing of this size, 1.5 m high; all other features are zero.
FeatureVector sized(float length, float width, float top = 1.5f) {
    FeatureVector f{};
    at(f, Feature::Length) = length;
    at(f, Feature::Width) = width;
    at(f, Feature::Top) = top;
    at(f, Feature::TopLimit) = top;
    return f;
}

constexpr auto kGrouping = Recognizer::Forest::Grouping;

Recognizer recognizer(const std::vector<ModelTree>& trees) { return Recognizer::parse(modelText(trees), "model"); }

/// The message with which a model is refused.
std::string complaint(const std::string& text) {
    try {
        Recognizer::parse(text, "some/model.txt");
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "accepted";
}

/// The text with one occurrence of `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
    const auto place = text.find(from);
    if (place == std::string::npos) throw std::logic_error("'" + from + "' is not in the model");
    return text.replace(place, from.size(), to);
}

/// Unknown by how far it reaches, Vehicle by its length.
std::vector<ModelTree> twoTrees() {
    return {stump(Feature::Range, 10.0f, 1.0f, -1.0f), stump(Feature::Length, 3.0f, 0.5f, 2.0f)};
}

TEST(Recognizer, TwoTreesGiveTheProbabilitiesWorkedOutByHand) {
    FeatureVector f = sized(4.0f, 1.5f);
    at(f, Feature::Range) = 5.0f;
    const CategoryProbabilities near =
        recognizer(twoTrees())(f, kGrouping);  // 1 for Unknown, 2 for Vehicle, 0 for the other six
    const double sum = std::exp(1.0) + std::exp(2.0) + 6.0;
    EXPECT_NEAR(of(near, Category::Unknown), std::exp(1.0) / sum, 1e-5);
    EXPECT_NEAR(of(near, Category::Vehicle), std::exp(2.0) / sum, 1e-5);
    EXPECT_NEAR(of(near, Category::Structure), 1.0 / sum, 1e-5);
    EXPECT_NEAR(std::accumulate(near.begin(), near.end(), 0.0), 1.0, 1e-5);
    at(f, Feature::Range) = 10.0f;  // not smaller than the limit: the other side
    const CategoryProbabilities far = recognizer(twoTrees())(f, kGrouping);
    EXPECT_NEAR(of(far, Category::Unknown) / of(far, Category::Vehicle), std::exp(-3.0), 1e-5);
}

TEST(Recognizer, ScoresAreTheSumsOfTheTreesOfEachCategory) {
    std::vector<ModelTree> trees(10, leaf(0.0f));
    trees[1] = leaf(0.5f);
    trees[9] = leaf(0.25f);  // the second round's vehicle
    const auto sums = recognizer(trees).scores(sized(4.0f, 1.5f), Recognizer::Forest::Grouping);
    EXPECT_FLOAT_EQ(sums[static_cast<std::size_t>(Category::Vehicle)], 0.75f);
    EXPECT_FLOAT_EQ(sums[static_cast<std::size_t>(Category::Unknown)], 0.0f);
}

TEST(Recognizer, TwoForestsAnswerTwoQuestions) {
    const Recognizer by_itself = recognizer(twoTrees());
    EXPECT_FALSE(by_itself.judgesSurroundings());
    // By itself a vehicle; among structure, structure.
    const std::vector<ModelTree> verdict = {leaf(0.0f), stump(Feature::NearStructure, 0.5f, 9.0f, 0.0f), leaf(0.0f),
                                            leaf(0.0f), stump(Feature::NearStructure, 0.5f, 0.0f, 9.0f)};
    const Recognizer model = Recognizer::parse(modelText({leaf(0.0f), leaf(9.0f)}, verdict), "model");
    EXPECT_TRUE(model.judgesSurroundings());
    FeatureVector f = sized(4.0f, 1.5f);
    at(f, Feature::NearStructure) = 0.9f;
    EXPECT_GT(of(model(f, kGrouping), Category::Vehicle), 0.9f);
    EXPECT_GT(of(model(f, Recognizer::Forest::Verdict), Category::Structure), 0.9f);
    at(f, Feature::NearStructure) = 0.1f;
    EXPECT_GT(of(model(f, Recognizer::Forest::Verdict), Category::Vehicle), 0.9f);
}

float scoreOf(const Recognizer& model, const FeatureVector& f) {
    return model.scores(f, Recognizer::Forest::Grouping)[0];
}

TEST(Recognizer, ATreeIsFollowedToItsLeaf) {
    // length below 2: 1; else width below 1: 2, else 3
    const ModelTree deep = {{2.0f, static_cast<int>(Feature::Length), 1},
                            {1.0f, -1, 0},
                            {1.0f, static_cast<int>(Feature::Width), 3},
                            {2.0f, -1, 0},
                            {3.0f, -1, 0}};
    const Recognizer model = recognizer({deep});
    EXPECT_EQ(scoreOf(model, sized(1.0f, 0.5f)), 1.0f);
    EXPECT_EQ(scoreOf(model, sized(4.0f, 0.5f)), 2.0f);
    EXPECT_EQ(scoreOf(model, sized(4.0f, 1.5f)), 3.0f);
}

/// Things of many kinds, drawn from a seed; in some one feature is infinite or no number.
std::vector<FeatureVector> drawn(std::size_t count) {
    std::mt19937 random(7);
    const auto share = [&] { return static_cast<float>(random() % 1000) / 1000.0f; };
    std::vector<FeatureVector> groups;
    groups.reserve(count);
    for (std::size_t k = 0; k < count; ++k) {
        FeatureVector f = sized(0.3f + 5.0f * share(), 0.2f + 2.0f * share(), 0.5f + 3.0f * share());
        at(f, Feature::Returns) = 2.0f + 8.0f * share();
        at(f, Feature::Range) = 2.0f + 30.0f * share();
        for (auto n = static_cast<std::size_t>(Feature::ShareKnee); n <= static_cast<std::size_t>(Feature::Fill); ++n)
            f[n] = share();
        if (k % 7 == 3) at(f, Feature::Gap) = std::numeric_limits<float>::infinity();
        if (k % 7 == 5) at(f, Feature::NextGap) = std::numeric_limits<float>::quiet_NaN();
        groups.push_back(f);
    }
    return groups;
}

TEST(Recognizer, ManyAtOnceAreToldTheSameAsOneByOne) {
    const auto model = recognizerOf("built-in");
    const std::vector<FeatureVector> groups = drawn(150);
    for (const auto forest : {Recognizer::Forest::Grouping, Recognizer::Forest::Verdict}) {
        std::vector<CategoryProbabilities> alone;
        for (const FeatureVector& f : groups) alone.push_back((*model)(f, forest));
        EXPECT_GT(std::set<CategoryProbabilities>(alone.begin(), alone.end()).size(), 100U);
        for (const int count : {0, 2, 3, 4, 15, 16, 17, 33, 64, 65, 100, 150}) {
            std::vector<const FeatureVector*> asked;
            for (int k = 0; k < count; ++k) asked.push_back(&groups[static_cast<std::size_t>(k)]);
            const auto part = std::vector<CategoryProbabilities>(alone.begin(), alone.begin() + count);
            EXPECT_EQ((*model)(asked, forest), part) << count;
        }
    }
}

TEST(Recognizer, TheCalibrationScalesAndShiftsTheSums) {
    const std::string text = with(modelText(twoTrees()), "grouping 1 0 0 0 0 0 0 0 0",  //
                                  "grouping 0.5 0 1 0 0 0 0 0 0");
    const CategoryProbabilities p = Recognizer::parse(text, "model")(sized(4.0f, 1.5f), kGrouping);
    EXPECT_NEAR(of(p, Category::Vehicle) / of(p, Category::Unknown), std::exp(0.5 * 2.0 + 1.0 - 0.5 * 1.0), 1e-4);
}

TEST(Recognizer, AModelWithoutTreesHoldsAllCategoriesForAsLikely) {
    const CategoryProbabilities p = recognizer({})(sized(1.2f, 1.2f), kGrouping);
    for (const float v : p) EXPECT_NEAR(v, 1.0 / kCategories, 1e-6);
}

TEST(Recognizer, WhatTheTrainingHasNotSeenIsUnknownAndRatherAMixture) {
    std::string text = modelText({leaf(0.0f), leaf(9.0f)});
    for (const char* name : {"range", "length", "width"})
        text = with(text, std::string("feature ") + name + " -1e9 1e9", std::string("feature ") + name + " 1 3");
    const Recognizer model = Recognizer::parse(text, "model");
    FeatureVector f = sized(2.0f, 2.0f);
    at(f, Feature::Range) = 2.0f;
    EXPECT_EQ(model.unseen(f), 0);
    at(f, Feature::Range) = 3.9f;
    EXPECT_EQ(model.unseen(f), 0) << "half a range beyond is near what was seen";
    at(f, Feature::Range) = 4.1f;
    at(f, Feature::Length) = -0.1f;
    EXPECT_EQ(model.unseen(f), 2);
    EXPECT_GT(of(model(f, kGrouping), Category::Vehicle), 0.9f) << "two may lie outside";
    at(f, Feature::Width) = std::nanf("");
    EXPECT_EQ(model.unseen(f), 3) << "what is no number was not seen";
    const CategoryProbabilities p = model(f, kGrouping);
    EXPECT_EQ(of(p, Category::Vehicle), 0.0f);
    EXPECT_NEAR(of(p, Category::Unknown) + of(p, Category::Mixture), 1.0f, 1e-6f);
    EXPECT_GT(of(p, Category::Mixture), of(p, Category::Unknown));
}

TEST(Recognizer, WhatIsTooLargeOrTooLowForAClassIsAMixture) {
    const Recognizer people = recognizer({leaf(0.0f), leaf(0.0f), leaf(9.0f)});
    EXPECT_GT(of(people(sized(0.6f, 0.5f, 1.7f), kGrouping), Category::Pedestrian), 0.9f);
    for (const FeatureVector& f : {sized(3.0f, 0.5f, 1.7f), sized(2.0f, 1.8f, 1.7f), sized(0.6f, 0.5f, 3.0f)}) {
        const CategoryProbabilities p = people(f, kGrouping);
        EXPECT_EQ(of(p, Category::Pedestrian), 0.0f);
        EXPECT_GT(of(p, Category::Mixture), 0.9f);
        EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-5);
    }
    const Recognizer vehicles = recognizer({leaf(0.0f), leaf(9.0f)});
    EXPECT_GT(of(vehicles(sized(18.0f, 2.5f, 3.0f), kGrouping), Category::Vehicle), 0.9f) << "an articulated bus";
    EXPECT_EQ(of(vehicles(sized(25.0f, 2.5f, 3.0f), kGrouping), Category::Vehicle), 0.0f);
    EXPECT_EQ(of(vehicles(sized(4.0f, 1.8f, 0.3f), kGrouping), Category::Vehicle), 0.0f);
}

TEST(Recognizer, BadModelsAreRefusedWithFileAndLine) {
    const std::string good = modelText(twoTrees());
    ASSERT_EQ(complaint(good), "accepted");
    const int trees = static_cast<int>(kFeatures) + 3;  // its line
    const auto line = [](int n) { return "some/model.txt, line " + std::to_string(n) + ": "; };
    EXPECT_EQ(complaint(""), line(1) + "the file ends here");
    EXPECT_NE(complaint("hello\n").find(line(1) + "expected 'lidar_obstacles_model', found 'hello'"),
              std::string::npos);
    EXPECT_NE(complaint(with(good, "model 2", "model 1")).find(line(1) + "this version"), std::string::npos);
    EXPECT_NE(complaint(with(good, "feature range", "feature rang")).find(line(3) + "expected 'range'"),
              std::string::npos);
    EXPECT_NE(complaint(with(good, "feature range -1e9", "feature range x")).find(line(3)), std::string::npos);
    EXPECT_NE(complaint(with(good, "grouping 1 0", "grouping 1")).find(line(trees - 1)), std::string::npos);
    EXPECT_NE(complaint(with(good, "trees 8", "trees -8")).find(line(trees)), std::string::npos);
    EXPECT_NE(
        complaint(with(good, "trees 8", "trees 7")).find(line(trees) + "expected as many trees for each category"),
        std::string::npos);
    // two trees of a head and three nodes, six of a head and a leaf
    const int verdict = trees + 2 * 4 + 6 * 2 + 1;
    EXPECT_NE(complaint(with(good, "trees 8", "trees 16")).find(line(verdict) + "expected 'tree', found 'verdict'"),
              std::string::npos);
    EXPECT_NE(complaint(with(good, "trees 0", "trees 8")).find(line(verdict + 2) + "the file ends here"),
              std::string::npos);
    EXPECT_NE(complaint(with(good, "tree 3", "tree 0")).find(line(trees + 1) + "a tree without nodes"),
              std::string::npos);
}

TEST(Recognizer, NodesThatLeadNowhereOrBackAreRefused) {
    const std::string good = modelText({stump(Feature::Range, 10.0f, 1.0f, -1.0f)});
    const std::string root = "2 10.000000 1";
    EXPECT_NE(complaint(with(good, root, "2 10.000000 2")).find("a node is 2"), std::string::npos);
    EXPECT_NE(complaint(with(good, root, "2 10.000000 0")).find("a node that leads back"), std::string::npos);
    EXPECT_NE(complaint(with(good, root, std::to_string(kFeatures + 1) + " 10.000000 1")).find("place of a feature"),
              std::string::npos);
    for (const char* limit : {"2 abc 1", "2 nan 1", "2 inf 1"})
        EXPECT_NE(complaint(with(good, root, limit)).find("expected a number"), std::string::npos) << limit;
    for (const char* leaf : {"0 nan", "0 inf", "0 1e30"})  // which no probabilities can be made of
        EXPECT_NE(complaint(with(good, "0 -1.000000", leaf)).find("expected a number"), std::string::npos) << leaf;
    EXPECT_NE(complaint(with(good, "grouping 1", "grouping nan")).find("expected a number"), std::string::npos);
}

TEST(RecognizerOf, TheBuiltInModelIsReadOnceAndAMissingFileIsNamed) {
    EXPECT_EQ(recognizerOf("built-in"), recognizerOf("built-in"));
    for (int k = 0; k < 2; ++k) {
        try {
            recognizerOf("/nonexistent/model.txt");
            FAIL() << "read";
        } catch (const std::runtime_error& e) {
            EXPECT_NE(std::string(e.what()).find("/nonexistent/model.txt"), std::string::npos) << e.what();
        }
    }
}

TEST(ClassesOf, PartsCountForTheirClassAndAMixtureIsUnknown) {
    CategoryProbabilities c{};
    c[static_cast<std::size_t>(Category::Vehicle)] = 0.2f;
    c[static_cast<std::size_t>(Category::VehiclePart)] = 0.2f;
    c[static_cast<std::size_t>(Category::Pedestrian)] = 0.1f;
    c[static_cast<std::size_t>(Category::Mixture)] = 0.5f;
    const ClassProbabilities p = classesOf(c);
    EXPECT_NEAR(of(p, ObstacleClass::Vehicle), 0.4f, 1e-6f);
    EXPECT_NEAR(of(p, ObstacleClass::Pedestrian), 0.1f, 1e-6f);
    EXPECT_NEAR(of(p, ObstacleClass::Unknown), 0.5f, 1e-6f);
}

TEST(ClassesOf, APartOfAPersonIsSharedAsWholePeopleAre) {
    CategoryProbabilities c{};
    c[static_cast<std::size_t>(Category::Pedestrian)] = 0.3f;
    c[static_cast<std::size_t>(Category::Cyclist)] = 0.1f;
    c[static_cast<std::size_t>(Category::PersonPart)] = 0.6f;
    const ClassProbabilities p = classesOf(c);
    EXPECT_NEAR(of(p, ObstacleClass::Pedestrian), 0.75f, 1e-6f);
    EXPECT_NEAR(of(p, ObstacleClass::Cyclist), 0.25f, 1e-6f);
}

TEST(ClassesOf, OfANothingButAMixtureTheClassIsUnknown) {
    CategoryProbabilities c{};
    c[static_cast<std::size_t>(Category::Mixture)] = 1.0f;
    EXPECT_EQ(of(classesOf(c), ObstacleClass::Unknown), 1.0f);
}

TEST(CategoryNames, AreAllDifferent) {
    std::set<std::string> names;
    for (std::size_t k = 0; k < kCategories; ++k) names.insert(toString(static_cast<Category>(k)));
    EXPECT_EQ(names.size(), kCategories);
}

}  // namespace
}  // namespace lidar_obstacles
