// SPDX-License-Identifier: BSD-3-Clause
#include "objects/joins.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "objects/expectations.h"
#include "objects/groups.h"

namespace lidar_obstacles {
namespace {

/// Two chosen hypotheses and what they would be together.
struct Union {
    int a = 0;
    int b = 0;
    float gain = 0.0f;
    Hypothesis whole;
    Footprint footprint;
    FeatureVector features{};
};

/// The chosen hypotheses of a tree, and what two of them would be together.
class ChosenUnions {
  public:
    ChosenUnions(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                 const GroupingParams& params)
        : tree_(tree), featuresOf_(featuresOf), recognizer_(recognizer), params_(params) {
        for (int k = 0; k < static_cast<int>(tree.hypotheses.size()); ++k)
            if (at(k).chosen) members_.push_back(k);
    }

    const std::vector<int>& members() const { return members_; }
    Hypothesis& at(int k) const { return tree_.hypotheses[static_cast<std::size_t>(k)]; }

    /// Those of these pairs that are within reach of each other and have returns enough to tell, scored: of each
    /// second one the nearest ones, so that the work grows with the scan and not with how crowded a hedge is.
    std::vector<Union> of(const std::vector<std::pair<int, int>>& pairs) const {
        std::vector<Union> unions;
        for (const Near& n : nearest(pairs)) unions.push_back(unscored(n));
        std::vector<const FeatureVector*> features;
        features.reserve(unions.size());
        for (const Union& u : unions) features.push_back(&u.features);
        const auto told = recognizer_(features, Recognizer::Forest::Grouping);
        for (std::size_t k = 0; k < unions.size(); ++k) {
            setScore(unions[k].whole, told[k], tree_.hypotheses);
            unions[k].gain = gainOf(unions[k].whole, tree_.hypotheses);
        }
        return unions;
    }

    /// Chooses it instead of the two. @return its place.
    int accept(Union&& u) {
        for (const int k : {u.a, u.b}) {
            at(k).chosen = false;
            members_.erase(std::find(members_.begin(), members_.end(), k));
        }
        members_.push_back(static_cast<int>(tree_.hypotheses.size()));
        u.whole.chosen = true;
        tree_.hypotheses.push_back(std::move(u.whole));
        tree_.footprints.push_back(u.footprint);
        tree_.features.push_back(u.features);
        return members_.back();
    }

  private:
    struct Near {
        int a, b;
        float link;  ///< as the scan could resolve it [m]
    };

    const Footprint& footprint(int k) const { return tree_.footprints[static_cast<std::size_t>(k)]; }

    /// The link of two that are within reach of each other and have returns enough to tell.
    std::optional<float> linkOf(int p, int q) const {
        const auto reach = static_cast<float>(params_.max_depth);
        if (footprint(p).box.squaredExteriorDistance(footprint(q).box) >= reach * reach) return std::nullopt;
        if (std::min(at(p).points.size(), at(q).points.size()) < kSpeck) return std::nullopt;
        const float link = linkBetween(footprint(p), footprint(q), featuresOf_.beams().cloud(), params_);
        if (link > params_.max_gap) return std::nullopt;
        return link;
    }

    std::vector<Near> nearest(const std::vector<std::pair<int, int>>& pairs) const {
        constexpr int kNearest = 4;
        std::vector<Near> near;
        for (const auto& [p, q] : pairs)
            if (const std::optional<float> link = linkOf(p, q)) near.push_back({p, q, *link});
        std::stable_sort(near.begin(), near.end(), [](const Near& m, const Near& n) { return m.link < n.link; });
        std::map<int, int> weighed;  // of each second one
        const auto crowded = [&](const Near& n) { return ++weighed[n.b] > kNearest; };
        near.erase(std::remove_if(near.begin(), near.end(), crowded), near.end());
        return near;
    }

    Union unscored(const Near& near) const {
        const Hypothesis& a = at(near.a);
        const Hypothesis& b = at(near.b);
        Union u{near.a, near.b, 0.0f, {}, merged(footprint(near.a), footprint(near.b)), {}};
        u.whole.part = {u.a, u.b};
        u.whole.pieces = a.pieces + b.pieces;
        u.whole.hanging = a.hanging + b.hanging;
        u.whole.gap = std::max({a.gap, b.gap, near.link});
        u.whole.points = a.points;
        u.whole.points.insert(u.whole.points.end(), b.points.begin(), b.points.end());
        u.whole.expected = expectedOfUnion(a, b);
        u.features = featuresOf_(u.whole, u.footprint);
        measureParts(u.whole, tree_.hypotheses, u.features);
        return u;
    }

    MergeTree& tree_;
    FeatureExtractor& featuresOf_;
    const Recognizer& recognizer_;
    const GroupingParams& params_;
    std::vector<int> members_;
};

/// Is it surely no part of a road user?
bool isStructure(const Hypothesis& h) {
    return h.probability[static_cast<std::size_t>(ObstacleClass::Structure)] > 0.9f;
}

/// Vehicles, or people and riders: the probability that a hypothesis is one, and that it is a small piece of one.
struct Kind {
    float whole = 0.0f;
    float piece = 0.0f;
};
Kind vehicle(const CategoryProbabilities& p) {
    return {p[static_cast<std::size_t>(Category::Vehicle)], p[static_cast<std::size_t>(Category::VehiclePart)]};
}
Kind person(const CategoryProbabilities& p) {
    return {p[static_cast<std::size_t>(Category::Pedestrian)] + p[static_cast<std::size_t>(Category::Cyclist)],
            p[static_cast<std::size_t>(Category::PersonPart)]};
}

constexpr float kLikely = 0.5f;
constexpr float kUnlikely = 0.1f;

bool isPiece(const Kind& k) { return k.piece > k.whole && k.piece + k.whole > kLikely; }

/// The best union of a piece with a larger one of its kind.
std::optional<Union> homeOf(int piece, Kind (*kind)(const CategoryProbabilities&), const ChosenUnions& unions) {
    std::vector<std::pair<int, int>> pairs;
    for (const int other : unions.members()) {
        const Kind k = kind(unions.at(other).category);
        const bool larger = unions.at(other).points.size() > unions.at(piece).points.size();
        if (other != piece && larger && k.whole + k.piece >= kLikely) pairs.emplace_back(other, piece);
    }
    std::optional<Union> best;
    for (Union& u : unions.of(pairs)) {
        if (u.whole.category[static_cast<std::size_t>(Category::Mixture)] > kUnlikely) continue;
        if (!best || u.whole.whole > best->whole.whole) best = std::move(u);
    }
    return best;
}

}  // namespace

void joinChosen(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                const GroupingParams& params) {
    ChosenUnions unions(tree, featuresOf, recognizer, params);
    std::vector<Union> open;
    std::vector<std::pair<int, int>> pairs;
    const auto mayBeOne = [&](int p, int q) {
        if (!isStructure(unions.at(p)) && !isStructure(unions.at(q))) pairs.emplace_back(p, q);
    };
    const auto weigh = [&] {
        for (Union& u : unions.of(pairs))
            if (u.gain > 0.0f) open.push_back(std::move(u));
        pairs.clear();
    };
    for (std::size_t q = 1; q < unions.members().size(); ++q)
        for (std::size_t p = 0; p < q; ++p) mayBeOne(unions.members()[p], unions.members()[q]);
    weigh();
    while (!open.empty()) {
        const auto best =
            std::max_element(open.begin(), open.end(), [](const Union& p, const Union& q) { return p.gain < q.gain; });
        Union u = std::move(*best);
        const auto uses = [&](const Union& v) { return v.a == u.a || v.b == u.b || v.a == u.b || v.b == u.a; };
        open.erase(std::remove_if(open.begin(), open.end(), uses), open.end());
        const int whole = unions.accept(std::move(u));
        for (const int other : unions.members())
            if (other != whole) mayBeOne(other, whole);
        weigh();
    }
}

void joinPieces(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                const GroupingParams& params) {
    ChosenUnions unions(tree, featuresOf, recognizer, params);
    for (Kind (*kind)(const CategoryProbabilities&) : {vehicle, person}) {
        std::vector<int> pieces;
        for (const int k : unions.members())
            if (isPiece(kind(unions.at(k).category))) pieces.push_back(k);
        std::stable_sort(pieces.begin(), pieces.end(), [&](int a, int b) {  // the largest first
            return unions.at(a).points.size() > unions.at(b).points.size();
        });
        for (const int piece : pieces) {
            if (!unions.at(piece).chosen) continue;
            std::optional<Union> home = homeOf(piece, kind, unions);
            if (!home) continue;
            const Hypothesis& larger = unions.at(home->a);
            home->whole.category = larger.category;
            home->whole.probability = larger.probability;
            home->whole.whole = larger.whole;
            unions.accept(std::move(*home));
        }
    }
}

}  // namespace lidar_obstacles
