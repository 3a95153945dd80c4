// SPDX-License-Identifier: BSD-3-Clause
#include "objects/walkers.h"

namespace lidar_obstacles {

Walkers::Walkers(std::vector<Walker>& all) {
    members_.reserve(all.size());
    for (Walker& w : all) members_.push_back({&w, 0});
    row_ = (all.size() + kBlock - 1) / kBlock * kBlock;
    ranks_.resize(row_ * kFeatures);
    places_.resize(row_);
    lineUp();
}

/// Gives those that still ask the first lanes.
void Walkers::lineUp() {
    constexpr int kMiddle = 128;
    lanes_ = members_.size();
    for (std::size_t lane = 0; lane < lanes_; ++lane) {
        members_[lane].lane = lane;
        const Ranks& ranks = members_[lane].walker->ranks;
        for (std::size_t k = 0; k < kFeatures; ++k)
            ranks_[k * row_ + lane] = static_cast<std::int8_t>(ranks[k] - kMiddle);
    }
}

}  // namespace lidar_obstacles
