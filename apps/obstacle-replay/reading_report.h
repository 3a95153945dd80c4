/// @file
/// What the decoding of a run's scans had to leave out or to guess.
#pragma once

#include <cstddef>
#include <string>

#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::apps {

/// Adds a remark to others, in one line.
void addRemark(std::string& remarks, const std::string& remark);

class ReadingReport {
  public:
    void add(const DecodeStats& stats);
    /// One line; empty if there is nothing to say.
    std::string text() const;

  private:
    std::size_t retimed_packets_ = 0;
    std::size_t damaged_blocks_ = 0;
    std::size_t scans_without_rings_ = 0;
};

}  // namespace lidar_obstacles::apps
