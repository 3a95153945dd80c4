// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/features.h"

namespace lidar_obstacles {

/// How many limits of each feature in a model its value reaches. What is no number reaches all.
using Ranks = std::array<std::uint8_t, kFeatures>;
/// What trees add to each category.
using CategorySums = std::array<float, kCategories>;

/// A group that asks boosted trees what it is, and what it was told so far.
struct Walker {
    Ranks ranks{};
    CategorySums sums{};
};

/// Groups that ask side by side, until each leaves.
class Walkers {
  public:
    static constexpr std::size_t kBlock = 64;  ///< lanes that are looked at together

    /// @param all  must outlive this.
    explicit Walkers(std::vector<Walker>& all);

    /// Those of whose sums this is true ask no longer.
    template <class Predicate>
    void release(const Predicate& done) {
        const auto leaves = [&](const Member& m) { return done(m.walker->sums); };
        members_.erase(std::remove_if(members_.begin(), members_.end(), leaves), members_.end());
        if (members_.size() + kVector <= lanes_) lineUp();
    }

    /// One that still asks.
    struct Member {
        Walker* walker;
        std::size_t lane;
    };
    /// In the order of their lanes.
    const std::vector<Member>& members() const { return members_; }
    std::size_t lanes() const { return lanes_; }
    /// Ranks of one feature, less 128, lane by lane. Behind the last lane any, up to a full block.
    const std::int8_t* ranksOf(std::size_t feature) const { return ranks_.data() + feature * row_; }
    /// Room for a number of each lane.
    std::uint8_t* places() { return places_.data(); }

  private:
    static constexpr std::size_t kVector = 16;  ///< lanes that a small processor compares at once
    void lineUp();

    std::vector<Member> members_;
    std::size_t lanes_ = 0;  ///< some are of walkers that have left
    std::size_t row_ = 0;
    std::vector<std::int8_t> ranks_;
    std::vector<std::uint8_t> places_;
};

}  // namespace lidar_obstacles
