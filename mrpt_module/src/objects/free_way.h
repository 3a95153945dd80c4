// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where a face of a box may move without meeting what beams show to be free or something else.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "lidar_obstacles/point_cloud.h"
#include "lidar_obstacles/types.h"
#include "scan/column_map.h"

namespace lidar_obstacles {

/// The strip that a face of a box would sweep when it moves outwards.
struct Strip {
    Eigen::Vector2d from;      ///< middle of the face where it is [m]
    Eigen::Vector2d outwards;  ///< unit length
    double length = 0.0;       ///< how far it is to move [m]
    double half = 0.0;         ///< half the face's width, less a margin [m]

    Eigen::Vector2d local(const Eigen::Vector2d& p) const {
        return {outwards.dot(p - from), outwards.x() * (p - from).y() - outwards.y() * (p - from).x()};
    }
};

/// What a vehicle fills of its box: no beam crosses it between belly and windows. Heights above the floor [m].
struct Body {
    double belly = 0.0;    ///< beams go through below
    double windows = 0.0;  ///< and above
    double top = 0.0;      ///< of what was seen
    double floor = 0.0;    ///< z of the ground it stands on, the cloud's frame
};

/// What the beams of a scan leave free. The cloud and the ground outlive it.
class FreeWay {
  public:
    /// What is seen higher above the ground than `ceiling` [m] is no obstacle: it stops no face.
    FreeWay(const PointCloud& cloud, const GroundModel& ground, double ceiling);

    /// Marks returns as those of the body that moves (1) or not (0).
    void own(const std::vector<std::int32_t>& returns, std::uint8_t value);
    /// How far a face may move [m], 0 .. strip.length: up to the third nearest beam that crosses its way.
    double operator()(const Strip& strip, const Body& body) const;

    /// How much of a strip is hidden: the share of the beams towards it, of the rings that met the body, that end
    /// before it. 0 where no beam goes there.
    double hiddenShare(const Strip& strip, const std::vector<std::int32_t>& body) const;

  private:
    struct Way;
    void enter(Way& way, std::int32_t i) const;
    double stopAt(const Way& way, std::int32_t i) const;
    template <class Look, class Blocked>
    void lookAlongColumns(const Strip& strip, std::size_t s, const Look& look, const Blocked& blocked) const;

    const PointCloud& cloud_;
    const GroundModel& ground_;
    double ceiling_;
    std::optional<ColumnMap> columns_;
    std::vector<SensorRays> sensors_;
    std::vector<std::uint8_t> own_;
};

}  // namespace lidar_obstacles
