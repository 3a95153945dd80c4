// SPDX-License-Identifier: BSD-3-Clause
#include "survey.h"

#include <memory>
#include <stdexcept>

#include "phantoms.h"

namespace lidar_obstacles::apps {

bool Survey::step(const Player& player) {
    if (!sequence_ || generation_ != player.generation()) {
        generation_ = player.generation();
        sequence_ = player.anotherSequence();
        sequence_->watchHealth();
        history_.clear();
    }
    const std::size_t next = history_.scans();
    if (next >= player.store().size() || !sequence_->ready(next)) return false;
    const auto scan = processed(next);
    ScanNotes notes;
    notes.health = sequence_->health();
    notes.took = 1e-3 * totalMs(*scan);
    if (const auto* truth = player.truthAt(next))
        notes.phantoms = phantomsIn(scan->result.obstacles, *truth, truth_fov_deg_);
    history_.add(scan->result, player.store().time(next), notes);
    return true;
}

/// A scan that cannot be read is an empty one here: who looks at it is told why.
std::shared_ptr<const ShownScan> Survey::processed(std::size_t index) {
    try {
        return sequence_->process(index);
    } catch (const std::runtime_error&) {
        sequence_->restart();
        return std::make_shared<ShownScan>();
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
