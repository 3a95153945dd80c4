// SPDX-License-Identifier: BSD-3-Clause
#include "objects/groups.h"

#include <algorithm>
#include <utility>

#include "lidar_obstacles/classification.h"
#include "objects/expectations.h"
#include "objects/footprint.h"
#include "objects/merge_tree.h"
#include "objects/surroundings.h"

namespace lidar_obstacles {

namespace {

/// What a hypothesis adds to the cut. Whoever takes two things for one loses one of them, whoever takes one for two
/// does not: a mixture is worse than parts.
float valueOf(const Hypothesis& h) {
    constexpr float kLoss = 0.5f;  // of a thing that is lost in a mixture
    const float likelier = likelierWhole(h);
    const float mixture = h.category[static_cast<std::size_t>(Category::Mixture)];
    const float worth = (likelier * h.whole - kLoss * mixture) / (1.0f + (likelier - 1.0f) * h.whole);
    return static_cast<float>(h.points.size()) * std::max(0.0f, worth);
}

/// What its two parts add, each cut in the best way. 0 for a piece.
float apart(const Hypothesis& h, const std::vector<Hypothesis>& tree) {
    if (h.part[0] < 0) return 0.0f;
    return tree[static_cast<std::size_t>(h.part[0])].cut + tree[static_cast<std::size_t>(h.part[1])].cut;
}

/// What hangs is one thing with what stands below it only in a vehicle: else several.
CategoryProbabilities mixedOnlyInVehicles(CategoryProbabilities verdict, const Hypothesis& h) {
    if (!isMixed(h)) return verdict;
    float& mixture = verdict[static_cast<std::size_t>(Category::Mixture)];
    for (const Category c :
         {Category::Unknown, Category::Pedestrian, Category::Cyclist, Category::Structure, Category::PersonPart})
        mixture += std::exchange(verdict[static_cast<std::size_t>(c)], 0.0f);
    return verdict;
}

}  // namespace

void setScore(Hypothesis& hypothesis, const CategoryProbabilities& verdict, const std::vector<Hypothesis>& tree) {
    hypothesis.category = mixedOnlyInVehicles(verdict, hypothesis);
    const auto of = [&](Category c) { return hypothesis.category[static_cast<std::size_t>(c)]; };
    hypothesis.probability = classesOf(hypothesis.category);
    hypothesis.whole = 1.0f - of(Category::VehiclePart) - of(Category::PersonPart) - of(Category::Mixture);
    hypothesis.cut = std::max(valueOf(hypothesis), apart(hypothesis, tree));
}

float gainOf(const Hypothesis& hypothesis, const std::vector<Hypothesis>& tree) {
    return valueOf(hypothesis) - apart(hypothesis, tree);
}

namespace {

/// Nothing is known of a speck but that it hardly is a whole thing.
CategoryProbabilities verdictOnSpeck() {
    constexpr float kWhole = 0.2f;
    CategoryProbabilities p{};
    p[static_cast<std::size_t>(Category::Unknown)] = kWhole;
    p[static_cast<std::size_t>(Category::Mixture)] = 1.0f - kWhole;
    return p;
}

/// The hypotheses by what has to be scored before them: pieces, what is made of pieces, and so on.
std::vector<std::vector<std::size_t>> byLevel(const std::vector<Hypothesis>& tree) {
    std::vector<std::size_t> level(tree.size(), 0);
    std::vector<std::vector<std::size_t>> levels;
    for (std::size_t k = 0; k < tree.size(); ++k) {
        for (const int part : tree[k].part)
            if (part >= 0) level[k] = std::max(level[k], level[static_cast<std::size_t>(part)] + 1);
        if (levels.size() <= level[k]) levels.emplace_back();
        levels[level[k]].push_back(k);
    }
    return levels;
}

/// Groups that a forest is asked about at once.
class Questions {
  public:
    explicit Questions(MergeTree& tree) : tree_(tree) {}
    void add(std::size_t k) {
        asked_.push_back(k);
        features_.push_back(&tree_.features[k]);
    }
    void answer(const Recognizer& recognizer, Recognizer::Forest forest) {
        const auto told = recognizer(features_, forest);
        for (std::size_t j = 0; j < asked_.size(); ++j)
            setScore(tree_.hypotheses[asked_[j]], told[j], tree_.hypotheses);
    }

  private:
    MergeTree& tree_;
    std::vector<std::size_t> asked_;
    std::vector<const FeatureVector*> features_;
};

/// Scores hypotheses whose parts are scored.
void scoreLevel(const std::vector<std::size_t>& level, MergeTree& tree, FeatureExtractor& featuresOf,
                const Recognizer& recognizer) {
    Questions questions(tree);
    for (const std::size_t k : level) {
        Hypothesis& h = tree.hypotheses[k];
        if (h.points.size() < kSpeck) {
            setScore(h, verdictOnSpeck(), tree.hypotheses);
            continue;
        }
        tree.features[k] = featuresOf(h, tree.footprints[k]);
        measureParts(h, tree.hypotheses, tree.features[k]);
        questions.add(k);
    }
    questions.answer(recognizer, Recognizer::Forest::Grouping);
}

}  // namespace

void score(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer) {
    tree.features.assign(tree.hypotheses.size(), {});
    for (const std::vector<std::size_t>& level : byLevel(tree.hypotheses))
        scoreLevel(level, tree, featuresOf, recognizer);
}

namespace {

/// Is it better than its two parts? Or as good, unless some of it hangs.
bool worthChoosing(const Hypothesis& h, const std::vector<Hypothesis>& tree) {
    const float gain = gainOf(h, tree);
    return isMixed(h) ? gain > 0.0f : gain >= 0.0f;
}

/// Chooses the best cut of what a hypothesis is made of, instead of itself. @param chosen  gets what is chosen now.
void chooseParts(std::size_t of, std::vector<Hypothesis>& tree, std::vector<std::size_t>& chosen) {
    std::vector<std::size_t> open{of};
    while (!open.empty()) {
        Hypothesis& h = tree[open.back()];
        open.pop_back();
        h.chosen = false;
        for (const int part : h.part) {
            const auto k = static_cast<std::size_t>(part);
            tree[k].chosen = worthChoosing(tree[k], tree);
            (tree[k].chosen ? chosen : open).push_back(k);
        }
    }
}

}  // namespace

void chooseBestCut(std::vector<Hypothesis>& tree) {
    for (Hypothesis& h : tree) {
        h.cut = std::max(valueOf(h), apart(h, tree));
        h.chosen = worthChoosing(h, tree);
    }
    std::vector<bool> taken(tree.size(), false);  // is in something chosen
    for (std::size_t k = tree.size(); k-- > 0;) {
        Hypothesis& h = tree[k];
        if (h.parent >= 0 && taken[static_cast<std::size_t>(h.parent)]) h.chosen = false;
        taken[k] = h.chosen || (h.parent >= 0 && taken[static_cast<std::size_t>(h.parent)]);
    }
}

void judgeChosen(MergeTree& tree, const Recognizer& recognizer) {
    const Surroundings surroundings(tree);  // each is judged by what grouping thought of the others
    const auto judge = [&](const std::vector<std::size_t>& groups) {
        Questions questions(tree);
        for (const std::size_t k : groups) {
            if (tree.hypotheses[k].points.size() < kSpeck) continue;
            surroundings.measure(k, tree.features[k]);
            questions.add(k);
        }
        questions.answer(recognizer, Recognizer::Forest::Verdict);
    };
    std::vector<std::size_t> chosen, parts;
    for (std::size_t k = 0; k < tree.hypotheses.size(); ++k)
        if (tree.hypotheses[k].chosen) chosen.push_back(k);
    judge(chosen);
    for (const std::size_t k : chosen) {
        const Hypothesis& h = tree.hypotheses[k];
        if (isMixed(h) && topClass(h.probability) != ObstacleClass::Vehicle) chooseParts(k, tree.hypotheses, parts);
    }
    judge(parts);
}

}  // namespace lidar_obstacles
