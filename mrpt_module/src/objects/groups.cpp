#include "objects/groups.h"

#include <algorithm>
#include <utility>

#include "objects/footprint.h"
#include "objects/merge_tree.h"

namespace lidar_obstacles {

namespace {

/// What a hypothesis adds to the cut.
float valueOf(const Hypothesis& h) { return static_cast<float>(h.points.size()) * h.whole; }

/// What its two parts add, each cut in the best way. 0 for a piece.
float apart(const Hypothesis& h, const std::vector<Hypothesis>& tree) {
    if (h.part[0] < 0) return 0.0f;
    return tree[static_cast<std::size_t>(h.part[0])].cut + tree[static_cast<std::size_t>(h.part[1])].cut;
}

}  // namespace

void setScore(Hypothesis& hypothesis, const CategoryProbabilities& verdict, const std::vector<Hypothesis>& tree) {
    const auto of = [&](Category c) { return verdict[static_cast<std::size_t>(c)]; };
    hypothesis.probability = classesOf(verdict);
    hypothesis.whole = 1.0f - of(Category::VehiclePart) - of(Category::PersonPart) - of(Category::Mixture);
    hypothesis.cut = std::max(valueOf(hypothesis), apart(hypothesis, tree));
}

float gainOf(const Hypothesis& hypothesis, const std::vector<Hypothesis>& tree) {
    return valueOf(hypothesis) - apart(hypothesis, tree);
}

namespace {

/// Is it surely no part of a road user?
bool isStructure(const Hypothesis& h) {
    return h.probability[static_cast<std::size_t>(ObstacleClass::Structure)] > 0.9f;
}

constexpr std::size_t kSpeck = 3;  // fewer returns have no shape

/// Nothing is known of a speck but that it hardly is a whole thing.
CategoryProbabilities verdictOnSpeck() {
    constexpr float kWhole = 0.2f;
    CategoryProbabilities p{};
    p[static_cast<std::size_t>(Category::Unknown)] = kWhole;
    p[static_cast<std::size_t>(Category::Mixture)] = 1.0f - kWhole;
    return p;
}

/// Two chosen hypotheses and what they would be together.
struct Union {
    int a = 0;
    int b = 0;
    float gain = 0.0f;
    Hypothesis whole;
    Footprint footprint;
};

/// Looks for the best of what chosen hypotheses could be joined to.
class ChosenJoiner {
  public:
    ChosenJoiner(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                 const GroupingParams& params)
        : tree_(tree.hypotheses),
          footprints_(tree.footprints),
          featuresOf_(featuresOf),
          recognizer_(recognizer),
          params_(params) {
        for (int k = 0; k < static_cast<int>(tree_.size()); ++k)
            if (tree_[static_cast<std::size_t>(k)].chosen) add(k);
    }

    void run() {
        while (!unions_.empty()) {
            const auto best = std::max_element(unions_.begin(), unions_.end(),
                                               [](const Union& p, const Union& q) { return p.gain < q.gain; });
            const Union u = std::move(*best);
            const auto uses = [&](const Union& v) { return v.a == u.a || v.b == u.b || v.a == u.b || v.b == u.a; };
            unions_.erase(std::remove_if(unions_.begin(), unions_.end(), uses), unions_.end());
            accept(u);
        }
    }

  private:
    /// Weighs a chosen hypothesis against all others so far.
    void add(int k) {
        for (const int other : members_) weigh(other, k);
        members_.push_back(k);
    }

    void weigh(int p, int q) {
        const auto reach = static_cast<float>(params_.max_depth);
        const Footprint& of_p = footprints_[static_cast<std::size_t>(p)];
        const Footprint& of_q = footprints_[static_cast<std::size_t>(q)];
        if (of_p.box.squaredExteriorDistance(of_q.box) >= reach * reach) return;
        const Hypothesis& a = tree_[static_cast<std::size_t>(p)];
        const Hypothesis& b = tree_[static_cast<std::size_t>(q)];
        if (isStructure(a) || isStructure(b)) return;
        if (std::min(a.points.size(), b.points.size()) < kSpeck) return;
        const float link = linkBetween(of_p, of_q, featuresOf_.beams().cloud(), params_);
        if (link > params_.max_gap) return;
        Union u{p, q, 0.0f, {}, merged(of_p, of_q)};
        u.whole.part = {u.a, u.b};
        u.whole.pieces = a.pieces + b.pieces;
        u.whole.gap = std::max({a.gap, b.gap, link});
        u.whole.points = a.points;
        u.whole.points.insert(u.whole.points.end(), b.points.begin(), b.points.end());
        FeatureVector features = featuresOf_(u.whole, u.footprint);
        measureParts(u.whole, tree_, features);
        setScore(u.whole, recognizer_(features), tree_);
        u.gain = gainOf(u.whole, tree_);
        if (u.gain > 0.0f) unions_.push_back(std::move(u));
    }

    void accept(const Union& u) {
        const int whole = static_cast<int>(tree_.size());
        for (const int k : {u.a, u.b}) {
            tree_[static_cast<std::size_t>(k)].chosen = false;
            members_.erase(std::find(members_.begin(), members_.end(), k));
        }
        tree_.push_back(u.whole);
        footprints_.push_back(u.footprint);
        tree_.back().chosen = true;
        add(whole);
    }

    std::vector<Hypothesis>& tree_;
    std::vector<Footprint>& footprints_;
    FeatureExtractor& featuresOf_;
    const Recognizer& recognizer_;
    const GroupingParams& params_;
    std::vector<int> members_;  ///< chosen hypotheses
    std::vector<Union> unions_;
};

}  // namespace

void score(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer) {
    for (std::size_t k = 0; k < tree.hypotheses.size(); ++k) {
        Hypothesis& h = tree.hypotheses[k];
        if (h.points.size() < kSpeck) {
            setScore(h, verdictOnSpeck(), tree.hypotheses);
            continue;
        }
        FeatureVector features = featuresOf(h, tree.footprints[k]);
        measureParts(h, tree.hypotheses, features);
        setScore(h, recognizer(features), tree.hypotheses);
    }
}

void chooseBestCut(std::vector<Hypothesis>& tree) {
    for (Hypothesis& h : tree) {
        h.cut = std::max(valueOf(h), apart(h, tree));
        h.chosen = gainOf(h, tree) >= 0.0f;
    }
    std::vector<bool> taken(tree.size(), false);  // is in something chosen
    for (std::size_t k = tree.size(); k-- > 0;) {
        Hypothesis& h = tree[k];
        if (h.parent >= 0 && taken[static_cast<std::size_t>(h.parent)]) h.chosen = false;
        taken[k] = h.chosen || (h.parent >= 0 && taken[static_cast<std::size_t>(h.parent)]);
    }
}

void joinChosen(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                const GroupingParams& params) {
    ChosenJoiner(tree, featuresOf, recognizer, params).run();
}

}  // namespace lidar_obstacles
