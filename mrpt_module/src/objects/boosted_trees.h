// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/features.h"
#include "lidar_obstacles/recognizer.h"
#include "objects/walkers.h"

namespace lidar_obstacles {

/// The trees of a model, laid out so that walking them needs few bytes and no guesses: all are complete to the same
/// depth, and instead of a feature and its limit they compare where both stand among all limits of that feature.
///
/// Many walkers pass the upper splits of a tree side by side: each split is put to all of them, and where they come out
/// is picked from the bottom up. Each goes on from there by itself.
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

    /// @param trees  tree t adds to category t modulo kCategories; none deeper than kDeepest, no limit that is no
    /// number, and no more limits of a feature than kMostLimits.
    explicit BoostedTrees(const std::vector<Tree>& trees);

    /// Of a round each category has a tree.
    std::size_t rounds() const { return rounds_; }
    /// Of each group one that has not been told anything yet.
    std::vector<Walker> walkersFor(const std::vector<const FeatureVector*>& groups) const;
    /// Adds what the trees of a round say to each that still asks.
    void addRound(std::size_t round, Walkers& walkers) const;

  private:
    static constexpr std::size_t kSteps = 16;  ///< a rank is found in two steps of so many limits
    static_assert(kSteps * kSteps == kMostLimits + 1);
    using Limits = std::array<float, kSteps>;
    /// All limits of a feature, rising, in rows; behind them infinite ones. Each row begins with one that everything
    /// reaches, and so does the list of the limits between the rows.
    struct SortedLimits {
        explicit SortedLimits(std::vector<float> limits);
        std::size_t rankOf(float value) const;

        Limits between;
        std::array<Limits, kSteps> rows;
    };
    struct Split {
        std::uint8_t feature;
        std::uint8_t limit;  ///< ranks up to this one go left
    };
    void layOut(const Tree& tree, const std::array<std::vector<float>, kFeatures>& limits);
    template <std::size_t kLanes>
    static void passUpper(const Split* tree, const Walkers& walkers, std::size_t first_lane, std::uint8_t* places);
    void passLower(const Split* tree, const float* leaves, std::size_t category, Walkers& walkers) const;
    void walkAlone(const Split* trees, const float* leaves, Walker& walker) const;
    static std::size_t below(const Split* tree, std::size_t i, const Ranks& ranks) {
        const Split s = tree[i];
        return i + i + static_cast<std::size_t>(s.limit < ranks[s.feature]);
    }

    std::size_t rounds_;
    int depth_;                           ///< of each tree
    std::vector<std::size_t> asked_for_;  ///< features that have limits
    std::vector<SortedLimits> limits_;    ///< of these
    std::vector<Split> splits_;  ///< of each tree 2^depth: what is below split i are 2i and 2i + 1; the root is 1
    std::vector<float> leaves_;  ///< of each tree 2^depth
};

}  // namespace lidar_obstacles
