// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How much of a zone the beams of a scan saw.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "lidar_obstacles/health.h"
#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/searched_place.h"
#include "lidar_obstacles/zones.h"
#include "sequence/zone_shape.h"

namespace lidar_obstacles {

/// What the detector looks at.
struct DetectorView {
    SearchedPlace searched;
    OwnBody own_body;
};

/// What was found out about a zone's area.
struct ZoneSight {
    double seen = 0.0;     ///< share
    bool blocked = false;  ///< part of it lies in a blocked sector
};

/// A zone as cells. A cell is seen where a beam passed through it, or ended in it, lower above the ground than
/// `object_height`: a thing of that height would have stopped it. Cells in the own body do not count; those that
/// are not searched (searched_place.h) are not seen.
class ZoneView {
  public:
    explicit ZoneView(const Zone& zone);

    /// @param T_zone_vehicle  into the frame of the zone's polygon.
    ZoneSight look(const SequenceResult& found, const Eigen::Isometry2d& T_zone_vehicle, const DetectorView& view,
                   const HealthReport* health);
    /// Did beams of the scan that was looked at pass through the whole part of an outline that lies in the zone, as
    /// high as a body would be, and go on? Then nothing of `object_height` stands there. False where no cell lies in
    /// both.
    /// @param outline  zone frame.
    bool passedThrough(const ZonePolygon& outline) const;

  private:
    struct Ray {
        Eigen::Vector2d from, to;  ///< the part of it below `object_height`, zone frame [m]
    };
    void mark(const PointCloud& cloud, const GroundModel& ground, const Eigen::Isometry2d& T_zone_vehicle);
    void mark(const Ray& ray, std::uint8_t how);

    double object_height_;
    double cell_ = 0.25;                             ///< edge [m]
    Eigen::Vector2d low_ = Eigen::Vector2d::Zero();  ///< lower left corner of the cells, zone frame [m]
    int columns_ = 0, rows_ = 0;
    std::vector<std::int32_t> inside_;  ///< cells with their middle in the polygon
    std::vector<std::uint8_t> seen_;    ///< one per cell: bits kSeen, kPassed
};

}  // namespace lidar_obstacles
