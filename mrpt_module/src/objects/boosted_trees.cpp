// SPDX-License-Identifier: BSD-3-Clause
#include "objects/boosted_trees.h"

#include <algorithm>
#include <limits>

namespace lidar_obstacles {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kRankBits = 8;
static_assert(BoostedTrees::kMostLimits == (std::size_t{1} << kRankBits) - 1);
constexpr std::size_t kSideBySide = 8;
constexpr std::size_t kTogether = 4;  // walks side by side: none waits for another
static_assert(kCategories % kTogether == 0);

int depthOf(const BoostedTrees::Tree& tree) {
    std::vector<int> depth(tree.size(), 0);
    for (std::size_t n = 0; n < tree.size(); ++n) {
        if (tree[n].feature < 0) continue;
        const auto next = static_cast<std::size_t>(tree[n].next);
        depth[next] = depth[next + 1] = depth[n] + 1;
    }
    return depth.empty() ? 0 : *std::max_element(depth.begin(), depth.end());
}

}  // namespace

BoostedTrees::BoostedTrees(const std::vector<Tree>& trees) : rounds_(trees.size() / kCategories) {
    std::array<std::vector<float>, kFeatures> limits;
    for (const Tree& tree : trees) {
        depth_ = std::max(depth_, depthOf(tree));
        for (const Node& n : tree)
            if (n.feature >= 0) limits[static_cast<std::size_t>(n.feature)].push_back(n.value);
    }
    for (std::size_t k = 0; k < kFeatures; ++k) {
        std::sort(limits[k].begin(), limits[k].end());
        limits_[k].fill(kInfinity);
        std::unique_copy(limits[k].begin(), limits[k].end(), limits_[k].begin());
        if (!limits[k].empty()) asked_for_.push_back(k);
    }
    splits_.reserve(trees.size() << depth_);
    leaves_.reserve(trees.size() << depth_);
    for (const Tree& tree : trees) layOut(tree);
}

/// Appends a tree. A leaf that is not at the bottom becomes splits that all go to the left.
void BoostedTrees::layOut(const Tree& tree) {
    constexpr Split kLeft{0, kMostLimits};
    const std::size_t size = std::size_t{1} << depth_;
    std::vector<int> node(2 * size, 0);  // of the tree, at each place
    splits_.push_back(kLeft);            // place 0 is not used
    for (std::size_t i = 1; i < size; ++i) {
        const Node& n = tree[static_cast<std::size_t>(node[i])];
        const bool leaf = n.feature < 0;
        node[2 * i] = leaf ? node[i] : n.next;
        node[2 * i + 1] = leaf ? node[i] : n.next + 1;
        if (leaf) {
            splits_.push_back(kLeft);
            continue;
        }
        const auto& limits = limits_[static_cast<std::size_t>(n.feature)];
        const auto place = std::lower_bound(limits.begin(), limits.end(), n.value) - limits.begin();
        splits_.push_back({static_cast<std::uint8_t>(n.feature), static_cast<std::uint8_t>(place)});
    }
    for (std::size_t i = size; i < 2 * size; ++i) leaves_.push_back(tree[static_cast<std::size_t>(node[i])].value);
}

BoostedTrees::Ranks BoostedTrees::ranksOf(const FeatureVector& features) const {
    Ranks ranks{};
    for (const std::size_t k : asked_for_) {
        const float* limits = limits_[k].data();
        std::size_t rank = 0;
        for (int bit = kRankBits - 1; bit >= 0; --bit) {
            const bool less = features[k] < limits[rank + (std::size_t{1} << bit) - 1];
            rank += static_cast<std::size_t>(!less) << bit;  // no branch: it could not be foreseen
        }
        ranks[k] = static_cast<std::uint8_t>(rank);
    }
    return ranks;
}

void BoostedTrees::addRound(std::size_t round, const std::vector<Walker*>& walkers) const {
    const std::size_t size = std::size_t{1} << depth_;
    const Split* splits = splits_.data() + round * kCategories * size;
    const float* leaves = leaves_.data() + round * kCategories * size;
    const std::size_t in_groups = walkers.size() - walkers.size() % kSideBySide;
    for (std::size_t k = 0; k < kCategories && in_groups > 0; ++k)
        for (std::size_t w = 0; w < in_groups; w += kSideBySide)
            walkTogether(splits + k * size, leaves + k * size, k, &walkers[w]);
    for (std::size_t w = in_groups; w < walkers.size(); ++w) walkAlone(splits, leaves, *walkers[w]);
}

/// Several walkers through one tree.
void BoostedTrees::walkTogether(const Split* tree, const float* leaves, std::size_t category,
                                Walker* const* walkers) const {
    std::array<const std::uint8_t*, kSideBySide> ranks;
    std::array<std::uint32_t, kSideBySide> at;
    for (std::size_t w = 0; w < kSideBySide; ++w) {
        ranks[w] = walkers[w]->ranks.data();
        at[w] = 1;
    }
    for (int level = 0; level < depth_; ++level)
        for (std::size_t w = 0; w < kSideBySide; ++w) {
            const Split s = tree[at[w]];
            at[w] = 2 * at[w] + static_cast<std::uint32_t>(ranks[w][s.feature] > s.limit);
        }
    const auto size = std::uint32_t{1} << depth_;
    for (std::size_t w = 0; w < kSideBySide; ++w) walkers[w]->sums[category] += leaves[at[w] - size];
}

/// One walker through several trees.
void BoostedTrees::walkAlone(const Split* trees, const float* leaves, Walker& walker) const {
    const std::size_t size = std::size_t{1} << depth_;
    for (std::size_t k = 0; k < kCategories; k += kTogether) {
        std::size_t a = 1, b = 1, c = 1, d = 1;
        for (int level = 0; level < depth_; ++level) {
            a = below(trees, a, walker.ranks);
            b = below(trees + size, b, walker.ranks);
            c = below(trees + 2 * size, c, walker.ranks);
            d = below(trees + 3 * size, d, walker.ranks);
        }
        walker.sums[k] += leaves[a - size];
        walker.sums[k + 1] += leaves[b];
        walker.sums[k + 2] += leaves[size + c];
        walker.sums[k + 3] += leaves[2 * size + d];
        trees += kTogether * size;
        leaves += kTogether * size;
    }
}

}  // namespace lidar_obstacles
