// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Poses of the vehicle from KITTI's inertial unit.
#pragma once

#include "kitti_files.h"

namespace lidar_obstacles::apps {

/// Poses of the vehicle from rows of oxts; the world's origin is where the first one is.
class OxtsPoses {
  public:
    OxtsPoses(const Words& first, const Eigen::Isometry3d& T_imu_vehicle)
        : latitude_deg_(first.number(0)),
          T_imu_vehicle_(T_imu_vehicle),
          origin_((poseOfOxts(first, latitude_deg_) * T_imu_vehicle).translation()) {}

    Eigen::Isometry3d vehicle(const Words& row) const {
        Eigen::Isometry3d T = poseOfOxts(row, latitude_deg_) * T_imu_vehicle_;
        T.translation() -= origin_;
        return T;
    }

  private:
    double latitude_deg_;
    Eigen::Isometry3d T_imu_vehicle_;
    Eigen::Vector3d origin_;
};

}  // namespace lidar_obstacles::apps
