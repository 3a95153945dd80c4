// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace lidar_obstacles {

/// Disjoint sets of labels 0 .. count-1 (union-find with path halving); a set is named by its smallest label.
class LabelSets {
  public:
    explicit LabelSets(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

    int find(int a) {
        while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
        return a;
    }
    /// At a glance: true only if they are in one set. Mostly that is seen so.
    bool seenJoined(int a, int b) const { return parent_[a] == parent_[b]; }
    void join(int a, int b) {
        if (seenJoined(a, b)) return;
        a = find(a);
        b = find(b);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<int> parent_;
};

}  // namespace lidar_obstacles
