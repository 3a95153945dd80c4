#include "survey.h"

namespace lidar_obstacles::apps {

bool Survey::step(const Player& player) {
    if (!sequence_ || generation_ != player.generation()) {
        generation_ = player.generation();
        sequence_ = player.anotherSequence();
        history_.clear();
    }
    const std::size_t next = history_.scans();
    if (next >= player.store().size() || !sequence_->ready(next)) return false;
    const auto scan = sequence_->process(next);
    history_.add(scan->result, player.store().time(next));
    return true;
}

bool Survey::complete(const Player& player) const {
    return player.store().complete() && generation_ == player.generation() && history_.scans() >= player.store().size();
}

const std::vector<HistoryPoint>& Survey::of(const Obstacle& obstacle, const Player& player) const {
    const auto id = history_.at(player.position(), obstacle.box.center.head<2>());
    return history_.of(id.value_or(-1));
}

}  // namespace lidar_obstacles::apps
