// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the decoding of a run's scans had to leave out or to guess.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::apps {

/// Adds a remark to others, in one line.
void addRemark(std::string& remarks, const std::string& remark);

class ReadingReport {
  public:
    void add(const DecodeStats& stats, const PointCloud& cloud);
    /// One line; empty if there is nothing to say.
    std::string text() const;

  private:
    std::size_t retimed_packets_ = 0;
    std::size_t damaged_blocks_ = 0;
    std::size_t scans_without_rings_ = 0;
    std::size_t scans_without_times_ = 0;
    std::size_t scans_without_returns_ = 0;
    std::size_t tilted_scans_ = 0;
    std::size_t backwards_ = 0;     ///< scans that are not stamped after the one before
    std::optional<double> newest_;  ///< stamp of the last scan [s]
};

}  // namespace lidar_obstacles::apps
