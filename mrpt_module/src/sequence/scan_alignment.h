// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Lays one scan onto a map of surfaces.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "sequence/match_points.h"
#include "sequence/surface_map.h"

namespace lidar_obstacles {

/// Where the vehicle is expected, and how far it may be from there.
struct ExpectedMove {
    Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();
    double place_std = 0.1;                          ///< [m]
    double turn_std = 0.02;                          ///< [rad]
    double reach = 0.1;                              ///< surfaces draw from so far at first [m]
    std::size_t every = 1;                           ///< of so many points one is asked
    Eigen::Vector2d held = Eigen::Vector2d::Zero();  ///< direction on the ground in which it stays there; zero: none
};

struct Alignment {
    Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();
    double residual = 0.0;  ///< median distance of returns from the surface they were laid on [m]
    double overlap = 0.0;   ///< share of the returns that were laid on one
    double fit = 0.0;       ///< the same, each by how well it lies there
    /// The same of what stands, each also by how sharp that surface is, in each eighth of the circle around the
    /// vehicle.
    std::array<double, 8> agreement{};
    /// What the scan says of the place on the ground, whatever the rotation is; inverse covariance, world axes [1/m^2].
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
};

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Gauss-Newton with weights that fall for what lies far from all surfaces; the reach shrinks from step to step.
/// @param straight  the scan's points in the vehicle frame in its middle [m].
Alignment align(const SurfaceMap& map, const MatchPoints& scan, const std::vector<Eigen::Vector3f>& straight,
                const ExpectedMove& expected);

}  // namespace lidar_obstacles
