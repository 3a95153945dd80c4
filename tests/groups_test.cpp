// SPDX-License-Identifier: BSD-3-Clause
// The best of what may be one object: cuts of trees whose scores are given, and joins beyond the tree.
#include "objects/groups.h"
#include "objects/joins.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "objects/merge_tree.h"
#include "support/feature_scene.h"
#include "support/size_model.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// A piece of so many returns, numbered from `first`, that is a whole object with this probability.
Hypothesis piece(int first, int returns, float whole) {
    Hypothesis h;
    for (int k = 0; k < returns; ++k) h.points.push_back(first + k);
    h.whole = whole;
    return h;
}

/// A verdict that is sure.
CategoryProbabilities sureOf(Category category) {
    CategoryProbabilities p{};
    p[static_cast<std::size_t>(category)] = 1.0f;
    return p;
}

/// Adds the join of two hypotheses to a tree.
void join(std::vector<Hypothesis>& tree, int a, int b, float whole) {
    Hypothesis h;
    h.part = {a, b};
    h.whole = whole;
    for (const int k : {a, b}) {
        Hypothesis& part = tree[static_cast<std::size_t>(k)];
        h.points.insert(h.points.end(), part.points.begin(), part.points.end());
        h.pieces += part.pieces;
        part.parent = static_cast<int>(tree.size());
    }
    --h.pieces;
    tree.push_back(h);
}

std::set<int> chosenOf(const std::vector<Hypothesis>& tree) {
    std::set<int> chosen;
    for (std::size_t k = 0; k < tree.size(); ++k)
        if (tree[k].chosen) chosen.insert(static_cast<int>(k));
    return chosen;
}

/// Pieces 0 .. 3 of ten returns; 4 = 0 + 1, 5 = 2 + 3, 6 = 4 + 5.
std::vector<Hypothesis> fourPieces(float pieces, float pairs, float all) {
    std::vector<Hypothesis> tree;
    for (int k = 0; k < 4; ++k) tree.push_back(piece(10 * k, 10, pieces));
    join(tree, 0, 1, pairs);
    join(tree, 2, 3, pairs);
    join(tree, 4, 5, all);
    return tree;
}

std::set<int> bestCut(std::vector<Hypothesis> tree) {
    chooseBestCut(tree);
    return chosenOf(tree);
}

TEST(Score, WhatHangsIsOneThingWithWhatStandsBelowItOnlyInAVehicle) {
    Hypothesis both = piece(0, 10, 0.0f);
    both.pieces = 2;
    both.hanging = 1;
    for (const Category c : {Category::Unknown, Category::Pedestrian, Category::Cyclist, Category::Structure}) {
        setScore(both, sureOf(c), {});
        EXPECT_EQ(both.category, sureOf(Category::Mixture));
        EXPECT_EQ(both.whole, 0.0f);
    }
    setScore(both, sureOf(Category::Vehicle), {});
    EXPECT_EQ(both.whole, 1.0f) << "the body of a truck, and its wheels";
    both.hanging = 2;
    setScore(both, sureOf(Category::Structure), {});
    EXPECT_EQ(both.whole, 1.0f) << "a crown in two pieces";
}

TEST(BestCut, OfNothingIsNothing) { EXPECT_TRUE(bestCut({}).empty()); }

TEST(BestCut, AWholeThatBeatsItsPartsIsKept) { EXPECT_EQ(bestCut(fourPieces(0.3f, 0.5f, 0.9f)), (std::set<int>{6})); }

TEST(BestCut, WhatIsWorthNothingIsKeptTogetherUnlessSomeOfItHangs) {
    std::vector<Hypothesis> tree{piece(0, 10, 0.0f), piece(10, 10, 0.0f)};
    join(tree, 0, 1, 0.0f);
    EXPECT_EQ(bestCut(tree), (std::set<int>{2}));
    tree[0].hanging = tree[2].hanging = 1;
    tree[2].pieces = 2;
    EXPECT_EQ(bestCut(tree), (std::set<int>{0, 1}));
}

TEST(BestCut, AMixtureFallsApart) {
    EXPECT_EQ(bestCut(fourPieces(0.3f, 0.8f, 0.1f)), (std::set<int>{4, 5}));
    EXPECT_EQ(bestCut(fourPieces(0.9f, 0.2f, 0.1f)), (std::set<int>{0, 1, 2, 3}));
}

TEST(BestCut, EachBranchIsCutWhereItIsBest) {
    std::vector<Hypothesis> tree = fourPieces(0.5f, 0.8f, 0.1f);
    tree[5].whole = 0.2f;
    EXPECT_EQ(bestCut(tree), (std::set<int>{2, 3, 4}));
}

TEST(BestCut, AGoodWholeFarUpIsNotLostBehindABadOneInBetween) {
    EXPECT_EQ(bestCut(fourPieces(0.5f, 0.1f, 0.9f)), (std::set<int>{6}));
}

TEST(BestCut, ReturnsCountNotPieces) {
    // a hundred returns surely one thing weigh more than two pieces of one return
    std::vector<Hypothesis> tree = {piece(0, 100, 0.2f), piece(100, 1, 1.0f), piece(101, 1, 1.0f)};
    join(tree, 0, 1, 0.9f);
    join(tree, 3, 2, 0.5f);
    EXPECT_EQ(bestCut(tree), (std::set<int>{2, 3}));
}

TEST(BestCut, HoldsEveryReturnOnceWhateverTheScores) {
    cv::RNG random(5);
    for (int run = 0; run < 50; ++run) {
        std::vector<Hypothesis> tree;
        std::set<int> open;
        for (int k = 0; k < 12; ++k) {
            open.insert(k);
            tree.push_back(piece(10 * k, 10, random.uniform(0.0f, 1.0f)));
        }
        for (int k = 0; k < 9; ++k) {
            const auto take = [&] {
                const int chosen = *std::next(open.begin(), random.uniform(0, static_cast<int>(open.size())));
                open.erase(chosen);
                return chosen;
            };
            const int a = take();
            const int b = take();
            open.insert(static_cast<int>(tree.size()));
            join(tree, a, b, random.uniform(0.0f, 1.0f));
        }
        chooseBestCut(tree);
        std::vector<int> seen(120, 0);
        for (const Hypothesis& h : tree)
            if (h.chosen)
                for (const std::int32_t i : h.points) ++seen[static_cast<std::size_t>(i)];
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 120) << run;
    }
}

TEST(SetScore, PartsAndMixturesAreNoWholes) {
    CategoryProbabilities verdict{};
    verdict[static_cast<std::size_t>(Category::Vehicle)] = 0.5f;
    verdict[static_cast<std::size_t>(Category::VehiclePart)] = 0.2f;
    verdict[static_cast<std::size_t>(Category::PersonPart)] = 0.1f;
    verdict[static_cast<std::size_t>(Category::Mixture)] = 0.2f;
    Hypothesis h;
    setScore(h, verdict, {});
    EXPECT_NEAR(h.whole, 0.5f, 1e-6f);
    EXPECT_NEAR(h.probability[static_cast<std::size_t>(ObstacleClass::Vehicle)], 0.7f, 1e-6f);
    EXPECT_EQ(h.category, verdict);
}

/// The boxes of a scan as hypotheses of their own.
MergeTree aloneIn(const Scan& scan, int boxes) {
    MergeTree tree;
    for (int b = 0; b < boxes; ++b) {
        tree.hypotheses.push_back(hypothesisOf(scan.returnsOn(b)));
        tree.footprints.push_back(footprintOf(scan.returnsOn(b), scan.cloud));
    }
    return tree;
}

/// Two posts 0.6 m apart across the view, and what is made of them by a model.
struct TwoPosts {
    Scan scan = scanOf({wallAt(8.0, -0.5, -0.3, 0.0, 1.7), wallAt(8.0, 0.3, 0.5, 0.0, 1.7)});
    GroundModel ground = knownGround(scan);
    Beams beams{scan.cloud};
    MergeTree tree = aloneIn(scan, 2);

    std::set<int> joinedBy(const std::vector<ModelTree>& trees, const GroupingParams& params = {}) {
        const Recognizer model = Recognizer::parse(modelText(trees), "model");
        FeatureExtractor featuresOf(beams, ground);
        score(tree, featuresOf, model);
        chooseBestCut(tree.hypotheses);
        EXPECT_EQ(chosenOf(tree.hypotheses), (std::set<int>{0, 1}));
        joinChosen(tree, featuresOf, model, params);
        EXPECT_EQ(tree.footprints.size(), tree.hypotheses.size());
        return chosenOf(tree.hypotheses);
    }
};

/// Vehicles are 0.8 m long at least; shorter things are parts of one.
std::vector<ModelTree> longerIsBetter() {
    return {leaf(0.0f), stump(Feature::Length, 0.8f, 0.0f, 8.0f), leaf(0.0f), leaf(0.0f),
            leaf(0.0f), stump(Feature::Length, 0.8f, 8.0f, 0.0f)};
}

TEST(JoinChosen, JoinsWhatTheScoreHoldsForOneObject) {
    TwoPosts scene;
    EXPECT_EQ(scene.joinedBy(longerIsBetter()), (std::set<int>{2}));
    const Hypothesis& whole = scene.tree.hypotheses[2];
    EXPECT_EQ(whole.points.size(), scene.tree.hypotheses[0].points.size() + scene.tree.hypotheses[1].points.size());
    EXPECT_EQ(whole.part, (std::array<int, 2>{0, 1}));
    EXPECT_EQ(whole.pieces, 2);
    EXPECT_NEAR(whole.gap, 0.6, 0.06);
    EXPECT_GT(whole.whole, 0.9f);
}

TEST(JoinChosen, LeavesApartWhatGainsNothing) {
    TwoPosts scene;
    const std::vector<ModelTree> shorterIsBetter = {
        leaf(0.0f), stump(Feature::Length, 0.8f, 8.0f, 0.0f), leaf(0.0f), leaf(0.0f), leaf(0.0f), leaf(0.0f),
        leaf(0.0f), stump(Feature::Length, 0.8f, 0.0f, 8.0f)};
    EXPECT_EQ(scene.joinedBy(shorterIsBetter), (std::set<int>{0, 1}));
    EXPECT_EQ(scene.tree.hypotheses.size(), 2u);
}

TEST(JoinChosen, LeavesApartWhatIsFartherApartThanTheLimit) {
    GroupingParams params;
    params.max_gap = 0.4;
    TwoPosts scene;
    EXPECT_EQ(scene.joinedBy(longerIsBetter(), params), (std::set<int>{0, 1}));
}

TEST(JoinChosen, LeavesWhatIsSurelyStructureAsItIs) {
    TwoPosts scene;
    const std::vector<ModelTree> structure = {leaf(0.0f), leaf(0.0f), leaf(0.0f), leaf(0.0f), leaf(9.0f)};
    EXPECT_EQ(scene.joinedBy(structure), (std::set<int>{0, 1}));
}

TEST(Score, OfASpeckNothingIsKnown) {
    TwoPosts scene;
    scene.tree.hypotheses[0].points.resize(2);
    scene.tree.footprints[0] = footprintOf(scene.tree.hypotheses[0].points, scene.scan.cloud);
    FeatureExtractor featuresOf(scene.beams, scene.ground);
    const std::vector<ModelTree> sure = {leaf(0.0f), leaf(9.0f)};
    score(scene.tree, featuresOf, Recognizer::parse(modelText(sure), "model"));
    EXPECT_LT(scene.tree.hypotheses[0].whole, 0.5f) << "two returns have no shape";
    EXPECT_EQ(scene.tree.hypotheses[0].probability[static_cast<std::size_t>(ObstacleClass::Unknown)], 1.0f);
    EXPECT_GT(scene.tree.hypotheses[1].whole, 0.9f);
}

TEST(JoinChosen, GoesOnAsLongAsAnythingGains) {
    std::vector<OrientedBox> posts;
    for (const double y : {-1.2, -0.4, 0.4, 1.2}) posts.push_back(wallAt(8.0, y - 0.1, y + 0.1, 0.0, 1.7));
    const Scan scan = scanOf(posts);
    const GroundModel ground = knownGround(scan);
    const Beams beams(scan.cloud);
    const Recognizer model = Recognizer::parse(modelText(longerIsBetter()), "model");
    MergeTree tree = aloneIn(scan, 4);
    FeatureExtractor featuresOf(beams, ground);
    score(tree, featuresOf, model);
    chooseBestCut(tree.hypotheses);
    joinChosen(tree, featuresOf, model, GroupingParams{});
    std::size_t held = 0;
    for (const Hypothesis& h : tree.hypotheses) {
        if (!h.chosen) continue;
        EXPECT_GT(h.whole, 0.9f) << "no post is left alone";
        held += h.points.size();
    }
    EXPECT_EQ(held, returnsOnAll(scan, {0, 1, 2, 3}).size());
}

/// Three boards 0.9 m wide that a model takes for vehicles by themselves; what has a vehicle within 3 m is structure.
TEST(JudgeChosen, TheVerdictKnowsWhatStandsAboutAGroup) {
    const Scan scan =
        scanOf({wallAt(8.0, -1.6, -0.7, 0.0, 1.7), wallAt(8.0, 0.7, 1.6, 0.0, 1.7), wallAt(8.0, 5.5, 6.4, 0.0, 1.7)});
    const GroundModel ground = knownGround(scan);
    const Beams beams(scan.cloud);
    const Recognizer model = Recognizer::parse(
        modelText({leaf(0.0f), leaf(9.0f)}, {leaf(0.0f), stump(Feature::VehicleAway, 3.0f, 0.0f, 9.0f), leaf(0.0f),
                                             leaf(0.0f), stump(Feature::VehicleAway, 3.0f, 9.0f, 0.0f)}),
        "model");
    FeatureExtractor featuresOf(beams, ground);
    MergeTree tree = aloneIn(scan, 3);
    score(tree, featuresOf, model);
    chooseBestCut(tree.hypotheses);
    judgeChosen(tree, model);
    const auto of = [&](std::size_t k, ObstacleClass c) {
        return tree.hypotheses[k].probability[static_cast<std::size_t>(c)];
    };
    EXPECT_GT(of(0, ObstacleClass::Structure), 0.9f);
    EXPECT_GT(of(1, ObstacleClass::Structure), 0.9f) << "judged by what grouping thought of its neighbour";
    EXPECT_GT(of(2, ObstacleClass::Vehicle), 0.9f);
}

TEST(JudgeChosen, WhatIsNoVehicleAfterAllLosesWhatHangs) {
    // grouping takes two boards for one vehicle; then all is judged to be people
    const Scan scan = scanOf({wallAt(8.0, -0.9, -0.1, 0.0, 1.7), wallAt(8.0, 0.1, 0.9, 0.0, 1.7)});
    const GroundModel ground = knownGround(scan);
    const Beams beams(scan.cloud);
    const auto part = [](float of_piece, float of_both) { return stump(Feature::LessShare, 0.0f, of_piece, of_both); };
    const std::vector<ModelTree> grouping = {leaf(0.0f), part(0.0f, 9.0f), leaf(0.0f),
                                             leaf(0.0f), leaf(0.0f),       part(9.0f, 0.0f)};
    const Recognizer model = Recognizer::parse(modelText(grouping, {leaf(0.0f), leaf(0.0f), leaf(9.0f)}), "model");
    for (const bool hangs : {false, true}) {
        std::vector<Cluster> pieces(2);
        for (const int k : {0, 1}) pieces[static_cast<std::size_t>(k)].points = scan.returnsOn(k);
        pieces[0].hangs = hangs;
        MergeTree tree = mergeTree(pieces, beams, GroupingParams{});
        FeatureExtractor featuresOf(beams, ground);
        score(tree, featuresOf, model);
        chooseBestCut(tree.hypotheses);
        EXPECT_EQ(chosenOf(tree.hypotheses), std::set<int>{2});
        judgeChosen(tree, model);
        EXPECT_EQ(chosenOf(tree.hypotheses), hangs ? (std::set<int>{0, 1}) : std::set<int>{2});
        for (const Hypothesis& h : tree.hypotheses)
            EXPECT_TRUE(!h.chosen || h.probability[static_cast<std::size_t>(ObstacleClass::Pedestrian)] > 0.9f);
    }
}

/// A board 1.8 m wide and a post 0.25 m beside it. Grouping finds each whole; in its surroundings the post is judged a
/// small piece of a vehicle.
struct BoardAndPost {
    Scan scan = scanOf({wallAt(8.0, -0.9, 0.9, 0.0, 1.7), wallAt(8.0, 1.15, 1.35, 0.0, 1.7)});
    GroundModel ground = knownGround(scan);
    Beams beams{scan.cloud};
    MergeTree tree = aloneIn(scan, 2);

    /// @param together  what grouping adds to Mixture for the union
    std::set<int> joinedWith(float together) {
        const std::vector<ModelTree> grouping = {
            leaf(0.0f), leaf(9.0f), leaf(0.0f), leaf(0.0f),
            leaf(0.0f), leaf(0.0f), leaf(0.0f), stump(Feature::LessShare, 0.0f, 0.0f, together)};
        const std::vector<ModelTree> verdict = {leaf(0.0f), stump(Feature::Length, 0.8f, 0.0f, 9.0f),
                                                leaf(0.0f), leaf(0.0f),
                                                leaf(0.0f), stump(Feature::Length, 0.8f, 9.0f, 0.0f)};
        const Recognizer model = Recognizer::parse(modelText(grouping, verdict), "model");
        FeatureExtractor featuresOf(beams, ground);
        score(tree, featuresOf, model);
        chooseBestCut(tree.hypotheses);
        judgeChosen(tree, model);
        joinPieces(tree, featuresOf, model, GroupingParams());
        return chosenOf(tree.hypotheses);
    }
};

TEST(JoinPieces, ASmallPieceGoesToTheVehicleBesideIt) {
    BoardAndPost scene;
    EXPECT_EQ(scene.joinedWith(0.0f), (std::set<int>{2}));
    const Hypothesis& whole = scene.tree.hypotheses[2];
    EXPECT_EQ(whole.points.size(), scene.tree.hypotheses[0].points.size() + scene.tree.hypotheses[1].points.size());
    EXPECT_EQ(whole.category, scene.tree.hypotheses[0].category) << "the verdict on the larger one";
}

TEST(JoinPieces, WhatTogetherIsRatherSeveralThingsStaysApart) {
    BoardAndPost scene;
    EXPECT_EQ(scene.joinedWith(18.0f), (std::set<int>{0, 1}));
}

}  // namespace
}  // namespace lidar_obstacles
