// SPDX-License-Identifier: BSD-3-Clause
#include "survey.h"

#include <stdexcept>
#include <utility>

#include "phantoms.h"

namespace lidar_obstacles::apps {

bool Survey::step(const Player& player) {
    if (!sequence_ || generation_ != player.generation()) {
        generation_ = player.generation();
        sequence_ = player.anotherSequence();
        history_.clear();
    }
    const std::size_t next = history_.scans();
    if (next >= player.store().size() || !sequence_->ready(next)) return false;
    const DetectionResult result = resultOf(next);
    const auto* truth = player.truthAt(next);
    history_.add(result, player.store().time(next),
                 truth ? phantomsIn(result.obstacles, *truth, truth_fov_deg_) : std::vector<int>{});
    return true;
}

/// A scan that cannot be read is an empty one here: who looks at it is told why.
DetectionResult Survey::resultOf(std::size_t index) {
    try {
        return std::move(sequence_->process(index)->result);
    } catch (const std::runtime_error&) {
        sequence_->restart();
        return {};
    }
}

bool Survey::complete(const Player& player) const {
    return player.store().complete() && generation_ == player.generation() && history_.scans() >= player.store().size();
}

const std::vector<HistoryPoint>& Survey::of(const Obstacle& obstacle, const Player& player) const {
    const auto id = history_.at(player.position(), obstacle.box.center.head<2>());
    return history_.of(id.value_or(-1));
}

}  // namespace lidar_obstacles::apps
