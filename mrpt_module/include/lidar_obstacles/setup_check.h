// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The first look at a sensor on its vehicle: how it sits, what it sees, and what of it the parameters should know.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What some scans tell of the sensor. Vehicle frame as the scans have it. Of no scans all is 0, empty or not set.
struct SetupReport {
    std::size_t scans = 0;
    double returns = 0.0;  ///< in the middle scan (median)

    std::size_t with_ground = 0;                    ///< scans in which the ground was found
    double ground_share = 0.0;                      ///< of the returns, in those scans
    std::optional<double> height;                   ///< of the sensor above the ground (median) [m]
    Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< normal of the ground, mean of the scans, unit length
    double tilt = 0.0;                              ///< angle between `up` and z [rad]

    int rings = 0;                       ///< 0: the scans name none
    std::vector<int> silent_rings;       ///< without a return in any scan, though rings above and below have some
    double lowest = 0.0, highest = 0.0;  ///< elevations of returns, from the sensor, in the vehicle frame [rad]
    double view = 0.0;                   ///< azimuths that returns come from [rad]; 2 pi all around

    double rate = 0.0;                  ///< scans per second (median); 0: one scan, or stamps that do not rise
    std::size_t gaps = 0;               ///< steps between scans longer than one and a half of the usual
    std::size_t steps_back = 0;         ///< scans that are not stamped after the one before
    bool point_times = false;           ///< returns have times
    std::optional<double> turn_begins;  ///< azimuth of the first returns of a turn [rad]; there with point_times
    std::size_t torn = 0;               ///< scans with a surface that the seam tore apart (seam.h)

    bool moved = false;       ///< the vehicle moves enough to tell its body from what stands around it
    OwnBody own_body;         ///< what stays in place and is not in `region.own_body` yet
    double own_share = 0.0;   ///< of the returns that are in `region.own_body`
    double near_share = 0.0;  ///< of the returns within 1 m of the sensor, above ground, not in `region.own_body`
};

/// Looks at scan after scan; the ground is searched for up to 30 degrees of slope where `ground.max_slope_deg` finds
/// none, so that a tilted mount is seen as such. An object is for one thread at a time.
class SetupCheck {
  public:
    /// @throws std::invalid_argument if `region.own_body` is not right.
    explicit SetupCheck(const DetectorParams& params);
    ~SetupCheck();

    /// @throws std::invalid_argument if a return is not finite.
    void add(const PointCloud& cloud);
    SetupReport report() const;

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

/// What was found, a line each: "sensor: 1.80 m above the ground, tilted by 0.3 deg" ... Empty for no scans.
std::vector<std::string> toLines(const SetupReport& report);

/// What to change in the configuration, a line each, as in config.ini with the reason behind it:
/// "region.own_body = box(...)   # ...". Empty where the parameters fit what was found.
std::vector<std::string> settingsFor(const SetupReport& report, const DetectorParams& params);

}  // namespace lidar_obstacles
