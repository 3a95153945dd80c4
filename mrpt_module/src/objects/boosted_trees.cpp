// SPDX-License-Identifier: BSD-3-Clause
#include "objects/boosted_trees.h"

#include <algorithm>
#include <limits>

namespace lidar_obstacles {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kUpper = 4;          // levels that walkers pass side by side
constexpr std::size_t kAhead = 2;  // trees
constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kFew = 4;       // fewer walkers go alone
constexpr std::size_t kTogether = 4;  // walks at a time: none waits for another
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

/// Asks for memory that is read soon.
template <class T>
void fetch([[maybe_unused]] const T* first, [[maybe_unused]] std::size_t count) {
#if defined(__GNUC__)
    const auto* at = reinterpret_cast<const char*>(first);
    for (std::size_t k = 0; k < count * sizeof(T); k += kCacheLine) __builtin_prefetch(at + k);
#endif
}

/// How many of so many limits a value reaches. What is no number reaches all.
template <std::size_t kCount>
std::size_t reached(const float* limits, float value) {
    std::int32_t beyond = 0;
    for (std::size_t k = 0; k < kCount; ++k) beyond += value < limits[k] ? 1 : 0;
    return kCount - static_cast<std::size_t>(beyond);
}

}  // namespace

BoostedTrees::SortedLimits::SortedLimits(std::vector<float> limits) {
    limits.resize(kSteps * kSteps, kInfinity);
    between.fill(-kInfinity);
    for (std::size_t row = 0; row < kSteps; ++row) {
        const auto first = limits.begin() + static_cast<std::ptrdiff_t>(row * kSteps);
        rows[row][0] = -kInfinity;
        std::copy_n(first, kSteps - 1, rows[row].begin() + 1);
        if (row + 1 < kSteps) between[row + 1] = first[kSteps - 1];
    }
}

std::size_t BoostedTrees::SortedLimits::rankOf(float value) const {
    const std::size_t row = reached<kSteps>(between.data(), value) - 1;
    return row * kSteps + reached<kSteps>(rows[row].data(), value) - 1;
}

BoostedTrees::BoostedTrees(const std::vector<Tree>& trees) : rounds_(trees.size() / kCategories), depth_(kUpper) {
    std::array<std::vector<float>, kFeatures> limits;
    for (const Tree& tree : trees) {
        depth_ = std::max(depth_, depthOf(tree));
        for (const Node& n : tree)
            if (n.feature >= 0) limits[static_cast<std::size_t>(n.feature)].push_back(n.value);
    }
    for (std::size_t k = 0; k < kFeatures; ++k) {
        std::vector<float>& l = limits[k];
        if (l.empty()) continue;
        std::sort(l.begin(), l.end());
        l.erase(std::unique(l.begin(), l.end()), l.end());
        asked_for_.push_back(k);
        limits_.emplace_back(l);
    }
    splits_.reserve((trees.size() + kAhead) << depth_);
    leaves_.reserve((trees.size() + kAhead) << depth_);
    for (const Tree& tree : trees) layOut(tree, limits);
    splits_.resize(splits_.size() + (kAhead << depth_));  // is fetched, never read
    leaves_.resize(leaves_.size() + (kAhead << depth_));
}

/// Appends a tree. A leaf that is not at the bottom becomes splits that all go to the left.
void BoostedTrees::layOut(const Tree& tree, const std::array<std::vector<float>, kFeatures>& limits) {
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
        const std::vector<float>& l = limits[static_cast<std::size_t>(n.feature)];
        const auto place = std::lower_bound(l.begin(), l.end(), n.value) - l.begin();
        splits_.push_back({static_cast<std::uint8_t>(n.feature), static_cast<std::uint8_t>(place)});
    }
    for (std::size_t i = size; i < 2 * size; ++i) leaves_.push_back(tree[static_cast<std::size_t>(node[i])].value);
}

std::vector<Walker> BoostedTrees::walkersFor(const std::vector<const FeatureVector*>& groups) const {
    std::vector<Walker> walkers(groups.size());
    for (std::size_t n = 0; n < asked_for_.size(); ++n) {
        const std::size_t k = asked_for_[n];
        for (std::size_t w = 0; w < groups.size(); ++w)
            walkers[w].ranks[k] = static_cast<std::uint8_t>(limits_[n].rankOf((*groups[w])[k]));
    }
    return walkers;
}

void BoostedTrees::addRound(std::size_t round, Walkers& walkers) const {
    const std::size_t size = std::size_t{1} << depth_;
    const Split* splits = splits_.data() + round * kCategories * size;
    const float* leaves = leaves_.data() + round * kCategories * size;
    if (walkers.members().size() < kFew) {
        for (const Walkers::Member& m : walkers.members()) walkAlone(splits, leaves, *m.walker);
        return;
    }
    constexpr std::size_t kSmall = Walkers::kBlock / 4;
    for (std::size_t k = 0; k < kCategories; ++k, splits += size, leaves += size) {
        fetch(splits + kAhead * size, size);
        fetch(leaves + kAhead * size, size);
        std::size_t lane = 0;
        for (; lane + 2 * kSmall < walkers.lanes(); lane += Walkers::kBlock)
            passUpper<Walkers::kBlock>(splits, walkers, lane, walkers.places());
        for (; lane < walkers.lanes(); lane += kSmall) passUpper<kSmall>(splits, walkers, lane, walkers.places());
        passLower(splits, leaves, k, walkers);
    }
}

namespace {

template <std::size_t kLanes>
using Lanes = std::array<std::uint8_t, kLanes>;

/// Of each lane the place below one of the last splits: left, or the one behind it.
template <std::size_t kLanes>
void part(const std::int8_t* ranks, std::int8_t limit, std::uint8_t left, Lanes<kLanes>& places) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        places[lane] = static_cast<std::uint8_t>(left + static_cast<std::uint8_t>(ranks[lane] > limit));
}

/// Of each lane the place that it comes to from a split, of the two that it comes to from the splits below.
template <std::size_t kLanes>
void choose(const std::int8_t* ranks, std::int8_t limit, const Lanes<kLanes>* below, Lanes<kLanes>& __restrict places) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const auto right = static_cast<std::uint8_t>(-static_cast<std::int8_t>(ranks[lane] > limit));
        places[lane] = static_cast<std::uint8_t>((below[1][lane] & right) | (below[0][lane] & ~right));
    }
}

}  // namespace

/// Finds for each lane the split of the tree that it comes to below the upper ones.
template <std::size_t kLanes>
void BoostedTrees::passUpper(const Split* tree, const Walkers& walkers, std::size_t first_lane, std::uint8_t* places) {
    constexpr int kMiddle = 128;  // that the ranks of lanes are less
    constexpr std::size_t kSplits = std::size_t{1} << kUpper;
    std::array<Lanes<kLanes>, kSplits> at;  // where lanes come to from each split
    const auto ranks = [&](std::size_t i) { return walkers.ranksOf(tree[i].feature) + first_lane; };
    const auto limit = [&](std::size_t i) { return static_cast<std::int8_t>(tree[i].limit - kMiddle); };
    for (std::size_t i = kSplits - 1; i >= kSplits / 2; --i)
        part<kLanes>(ranks(i), limit(i), static_cast<std::uint8_t>(2 * i), at[i]);
    for (std::size_t i = kSplits / 2 - 1; i > 0; --i) choose<kLanes>(ranks(i), limit(i), &at[2 * i], at[i]);
    std::copy(at[1].begin(), at[1].end(), places + first_lane);
}

/// Brings all from where they are to their leaves of a tree.
void BoostedTrees::passLower(const Split* tree, const float* leaves, std::size_t category, Walkers& walkers) const {
    const std::vector<Walkers::Member>& members = walkers.members();
    const std::uint8_t* places = walkers.places();
    leaves -= std::size_t{1} << depth_;
    std::size_t m = 0;
    for (; m + kTogether <= members.size(); m += kTogether) {
        const Walkers::Member* four = &members[m];
        std::size_t a = places[four[0].lane], b = places[four[1].lane], c = places[four[2].lane],
                    d = places[four[3].lane];
        for (int level = kUpper; level < depth_; ++level) {
            a = below(tree, a, four[0].walker->ranks);
            b = below(tree, b, four[1].walker->ranks);
            c = below(tree, c, four[2].walker->ranks);
            d = below(tree, d, four[3].walker->ranks);
        }
        four[0].walker->sums[category] += leaves[a];
        four[1].walker->sums[category] += leaves[b];
        four[2].walker->sums[category] += leaves[c];
        four[3].walker->sums[category] += leaves[d];
    }
    for (; m < members.size(); ++m) {
        std::size_t a = places[members[m].lane];
        for (int level = kUpper; level < depth_; ++level) a = below(tree, a, members[m].walker->ranks);
        members[m].walker->sums[category] += leaves[a];
    }
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
