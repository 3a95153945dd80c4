// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where tracks came from, to be drawn behind them.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <map>
#include <vector>

#include "lidar_obstacles/detector.h"

namespace lidar_obstacles {

/// The way of one track's centre, oldest first; it ends at the centre of its box.
struct TrackTail {
    int id = 0;
    std::vector<Eigen::Vector3d> points;  ///< in the frame that the box is in [m]
};

/// Remembers the last scans of a sequence. With the vehicle's poses a tail is the way over ground, without them the way
/// seen from the vehicle.
/// An object is for one thread at a time.
class TrackTails {
  public:
    /// @param seconds  length of a tail.
    explicit TrackTails(double seconds = 3.0) : seconds_(seconds) {}

    /// The next scan of a sequence; one that is not later than the last begins anew.
    /// @param trajectory  of the detector that found it.
    void add(const SequenceResult& found, const Trajectory& trajectory);
    void clear() { ways_.clear(); }

    /// Tails of the tracks of the last scan, in their order; one that is new has none.
    const std::vector<TrackTail>& tails() const { return tails_; }

  private:
    struct Place {
        double time;
        Eigen::Vector3d at;  ///< world frame [m]
    };

    double seconds_;
    double last_time_ = 0.0;
    std::map<int, std::deque<Place>> ways_;
    std::vector<TrackTail> tails_;
};

}  // namespace lidar_obstacles
