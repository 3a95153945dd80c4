// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What stands in a zone and counts by its rule.
#pragma once

#include <optional>
#include <vector>

#include "lidar_obstacles/zones.h"
#include "sequence/zone_contact.h"
#include "sequence/zone_view.h"

namespace lidar_obstacles {

/// A scan, prepared for all zones.
struct ZoneScene {
    const SequenceResult& found;
    std::vector<std::int32_t> loose;      ///< candidates that are in no obstacle
    ZonePolygon vehicle;                  ///< its outline; empty: not told
    std::optional<VehicleMotion> motion;  ///< not set: not known
};

ZoneScene zoneScene(const SequenceResult& found, const Outline& vehicle, const Trajectory& trajectory);

/// A zone as this scan has it.
struct PlacedZone {
    const ZoneRule& rule;
    ZonePolygon polygon;   ///< vehicle frame
    const ZoneView& view;  ///< that looked at the scan
    Eigen::Isometry2d T_zone_vehicle;
};

/// What was found in a zone.
struct ZoneContent {
    std::optional<ZoneReason> reason;       ///< that makes it occupied; not set: none does
    bool speed_missing = false;             ///< something is in it, and how soon it is reached cannot be said
    bool ground_missing = false;            ///< in a part of it
    int returns = 0;                        ///< of all that counts
    std::optional<double> nearest;          ///< of what counts [m]
    std::optional<double> time_to_contact;  ///< the soonest [s]
    int id = -1;                            ///< of the obstacle that makes it occupied, the nearest of them
    ObstacleClass cls = ObstacleClass::Unknown;
};

ZoneContent contentOf(const PlacedZone& zone, const ZoneScene& scene);

}  // namespace lidar_obstacles
