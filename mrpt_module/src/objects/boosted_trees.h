// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/features.h"
#include "lidar_obstacles/recognizer.h"

namespace lidar_obstacles {

/// The trees of a model, laid out so that walking them needs few bytes and no guesses: all are complete to the same
/// depth, and instead of a feature and its limit they compare where both stand among all limits of that feature.
class BoostedTrees {
  public:
    static constexpr int kDeepest = 12;
    static constexpr std::size_t kMostLimits = 255;  ///< different ones of a feature

    /// A node as a model has it.
    struct Node {
        float value = 0.0f;  ///< limit: smaller goes on at `next`, all else after it; of a leaf: what it adds
        int feature = -1;    ///< -1: leaf
        int next = 0;        ///< counted from the tree's first node, larger than this one's own place
    };
    using Tree = std::vector<Node>;
    using Sums = std::array<float, kCategories>;
    /// How many limits of each feature its value reaches. What is no number reaches all.
    using Ranks = std::array<std::uint8_t, kFeatures>;

    /// @param trees  tree t adds to category t modulo kCategories; none deeper than kDeepest, no limit that is no
    /// number, and no more limits of a feature than kMostLimits.
    explicit BoostedTrees(const std::vector<Tree>& trees);

    /// Of a round each category has a tree.
    std::size_t rounds() const { return rounds_; }
    Ranks ranksOf(const FeatureVector& features) const;
    /// One that asks, and what it was told so far.
    struct Walker {
        Ranks ranks;
        Sums sums{};
    };
    /// Adds what the trees of a round say to each.
    void addRound(std::size_t round, const std::vector<Walker*>& walkers) const;

  private:
    struct Split {
        std::uint8_t feature;
        std::uint8_t limit;  ///< ranks up to this one go left
    };
    void layOut(const Tree& tree);
    std::size_t below(const Split* tree, std::size_t i, const Ranks& ranks) const {
        const Split s = tree[i];
        return 2 * i + static_cast<std::size_t>(ranks[s.feature] > s.limit);
    }
    void walkTogether(const Split* tree, const float* leaves, std::size_t category, Walker* const* walkers) const;
    void walkAlone(const Split* trees, const float* leaves, Walker& walker) const;

    std::size_t rounds_;
    int depth_ = 0;
    std::array<std::array<float, kMostLimits>, kFeatures> limits_;  ///< of each feature, rising; then infinite ones
    std::vector<std::size_t> asked_for_;                            ///< features that have limits
    std::vector<Split> splits_;  ///< of each tree 2^depth: what is below split i are 2i and 2i + 1; the root is 1
    std::vector<float> leaves_;  ///< of each tree 2^depth
};

}  // namespace lidar_obstacles
