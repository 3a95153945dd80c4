// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CObservationGPS.h>

#include <Eigen/Core>
#include <optional>

namespace lidar_obstacles {

/// What one observation of a GPS receiver tells.
struct GpsFix {
    std::optional<Eigen::Vector2d> latitude_longitude;  ///< [rad]
    std::optional<double> height;                       ///< [m]
    std::optional<double> heading;                      ///< clockwise from north [rad]
    bool stands = false;                                ///< too slow for a course to be a heading
    double pitch = 0.0;                                 ///< nose down [rad]
    double roll = 0.0;                                  ///< left side up [rad]
};

/// Reads INSPVAS, GGA, RMC and VTG. A course over ground is a heading only above half a metre per second: slower, it is
/// noise; at standstill there is none, and the last one holds.
GpsFix readGps(const mrpt::obs::CObservationGPS& observation);

/// East, north, up of `place` around `origin` [m]; both latitude, longitude [rad], height [m] (WGS 84). Good for tens
/// of kilometres: a thousandth of the way at 60.
Eigen::Vector3d eastNorthUp(const Eigen::Vector3d& place, const Eigen::Vector3d& origin);

}  // namespace lidar_obstacles
