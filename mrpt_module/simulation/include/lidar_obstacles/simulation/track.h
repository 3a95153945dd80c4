// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The middle line of a road: from arc length to a place in the world.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "lidar_obstacles/simulation/scenario.h"

namespace lidar_obstacles::simulation {

/// Frame: the world, z up; the track starts at the origin.
struct TrackPoint {
    Eigen::Vector2d position;
    double heading;    ///< of the track
    double elevation;  ///< z of the middle line
    double bank;       ///< left side up
};

/// A road along its middle line. Its const members may be called by several threads at a time.
class Track {
  public:
    /// @throws std::invalid_argument if the segments are empty, or a closed track misses its start by more than a
    ///         thirtieth of its length, does not turn by a full circle, or ends at another height or
    ///         bank than it begins; smaller gaps are spread over the lap.
    explicit Track(const TrackSpec& spec);

    double length() const { return length_; }
    bool closed() const { return spec_.closed; }
    double width() const { return spec_.width; }

    /// The middle line at s. A closed track goes on with the next lap; an open one straight on beyond its ends.
    TrackPoint at(double s) const;
    /// The place d to the left of it.
    Eigen::Vector2d place(double s, double d) const;
    /// True if s is on the track (always, if it is closed).
    bool has(double s) const { return spec_.closed || (s >= 0.0 && s <= length_); }

  private:
    struct Node {
        Eigen::Vector2d position;
        double heading;
    };

    double wrap(double s) const;
    double rawHeading(double s) const;
    double smoothHeading(double s) const;
    void closeGap();

    TrackSpec spec_;
    double length_ = 0.0;
    double total_turn_ = 0.0;
    double step_ = 0.0;  ///< between nodes [m]
    std::vector<Node> nodes_;
};

}  // namespace lidar_obstacles::simulation
