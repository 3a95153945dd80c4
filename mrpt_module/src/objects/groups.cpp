#include "objects/groups.h"

#include <algorithm>
#include <utility>

#include "objects/footprint.h"
#include "objects/merge_tree.h"

namespace lidar_obstacles {

void setScore(Hypothesis& hypothesis, const CategoryProbabilities& verdict) {
    const auto of = [&](Category c) { return verdict[static_cast<std::size_t>(c)]; };
    hypothesis.probability = classesOf(verdict);
    hypothesis.whole = 1.0f - of(Category::VehiclePart) - of(Category::PersonPart) - of(Category::Mixture);
}

namespace {

/// What a hypothesis adds to the cut.
float valueOf(const Hypothesis& h) { return static_cast<float>(h.points.size()) * h.whole; }

bool isStructure(const Hypothesis& h) {
    return h.probability[static_cast<std::size_t>(ObstacleClass::Structure)] > 0.5f;
}

/// Two chosen hypotheses and what they would be together.
struct Union {
    int a = 0;
    int b = 0;
    float gain = 0.0f;
    Hypothesis whole;
};

/// Looks for the best of what chosen hypotheses could be joined to.
class ChosenJoiner {
  public:
    ChosenJoiner(std::vector<Hypothesis>& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                 const GroupingParams& params)
        : tree_(tree), featuresOf_(featuresOf), recognizer_(recognizer), params_(params) {
        for (int k = 0; k < static_cast<int>(tree.size()); ++k)
            if (tree[static_cast<std::size_t>(k)].chosen) add(k);
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
    struct Member {
        int hypothesis;
        Footprint footprint;
    };

    /// Weighs a chosen hypothesis against all others so far.
    void add(int k) {
        const Hypothesis& h = tree_[static_cast<std::size_t>(k)];
        Member mine{k, footprintOf(h.points, featuresOf_.beams().cloud())};
        for (const Member& other : members_) weigh(other, mine);
        members_.push_back(std::move(mine));
    }

    void weigh(const Member& p, const Member& q) {
        const auto reach = static_cast<float>(params_.max_depth);
        if (p.footprint.box.squaredExteriorDistance(q.footprint.box) >= reach * reach) return;
        const Hypothesis& a = tree_[static_cast<std::size_t>(p.hypothesis)];
        const Hypothesis& b = tree_[static_cast<std::size_t>(q.hypothesis)];
        if (isStructure(a) && isStructure(b)) return;
        const float link = linkBetween(p.footprint, q.footprint, featuresOf_.beams().cloud(), params_);
        if (link > params_.max_gap) return;
        Union u{p.hypothesis, q.hypothesis, 0.0f, {}};
        u.whole.part = {u.a, u.b};
        u.whole.pieces = a.pieces + b.pieces;
        u.whole.gap = std::max({a.gap, b.gap, link});
        u.whole.points = a.points;
        u.whole.points.insert(u.whole.points.end(), b.points.begin(), b.points.end());
        setScore(u.whole, recognizer_(featuresOf_(u.whole)));
        u.gain = valueOf(u.whole) - valueOf(a) - valueOf(b);
        if (u.gain > 0.0f) unions_.push_back(std::move(u));
    }

    void accept(const Union& u) {
        const int whole = static_cast<int>(tree_.size());
        for (const int k : {u.a, u.b}) {
            tree_[static_cast<std::size_t>(k)].chosen = false;
            members_.erase(
                std::find_if(members_.begin(), members_.end(), [&](const Member& m) { return m.hypothesis == k; }));
        }
        tree_.push_back(u.whole);
        tree_.back().chosen = true;
        add(whole);
    }

    std::vector<Hypothesis>& tree_;
    FeatureExtractor& featuresOf_;
    const Recognizer& recognizer_;
    const GroupingParams& params_;
    std::vector<Member> members_;
    std::vector<Union> unions_;
};

}  // namespace

void score(std::vector<Hypothesis>& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer) {
    for (Hypothesis& h : tree) setScore(h, recognizer(featuresOf(h)));
}

void chooseBestCut(std::vector<Hypothesis>& tree) {
    std::vector<float> best(tree.size());
    for (std::size_t k = 0; k < tree.size(); ++k) {
        Hypothesis& h = tree[k];
        best[k] = valueOf(h);
        h.chosen = true;
        if (h.part[0] < 0) continue;
        const float apart = best[static_cast<std::size_t>(h.part[0])] + best[static_cast<std::size_t>(h.part[1])];
        h.chosen = best[k] >= apart;
        best[k] = std::max(best[k], apart);
    }
    std::vector<bool> taken(tree.size(), false);  // is in something chosen
    for (std::size_t k = tree.size(); k-- > 0;) {
        Hypothesis& h = tree[k];
        if (h.parent >= 0 && taken[static_cast<std::size_t>(h.parent)]) h.chosen = false;
        taken[k] = h.chosen || (h.parent >= 0 && taken[static_cast<std::size_t>(h.parent)]);
    }
}

void joinChosen(std::vector<Hypothesis>& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                const GroupingParams& params) {
    ChosenJoiner(tree, featuresOf, recognizer, params).run();
}

}  // namespace lidar_obstacles
