// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Goes through all scans of a file while nothing else is to be done, for their marks and histories.
#pragma once

#include <memory>

#include "history.h"
#include "player.h"

namespace lidar_obstacles::apps {

/// What a run from the first scan on finds, with the parameters that the player has. It reads from the store and so
/// belongs to the player's thread.
class Survey {
  public:
    /// @param truth_fov_deg  angle ahead that is labelled, where truth is given: beyond it nothing is a phantom.
    explicit Survey(double truth_fov_deg = 360.0) : truth_fov_deg_(truth_fov_deg) {}

    /// One scan more, if its poses are known and it is in the index; from the first one where the player's parameters
    /// have changed. @return true if there was something to do.
    bool step(const Player& player);
    bool complete(const Player& player) const;
    const History& history() const { return history_; }
    /// The history of an obstacle of the scan that is shown; empty where the survey has not come to it.
    const std::vector<HistoryPoint>& of(const Obstacle& obstacle, const Player& player) const;

  private:
    std::shared_ptr<const ShownScan> processed(std::size_t index);

    double truth_fov_deg_;
    std::unique_ptr<Sequence> sequence_;
    std::size_t generation_ = 0;  ///< of the player's sequences that it follows
    History history_;
};

}  // namespace lidar_obstacles::apps
