// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the scans that obstacle-check looks at, with the sensor where it is said to be, or turned upside down.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <string>

#include "lidar_obstacles/setup_check.h"
#include "options.h"

namespace lidar_obstacles::apps {

struct Look {
    SetupReport report;
    std::string lidar;                 ///< its name
    mrpt::poses::CPose3D sensor_pose;  ///< on the vehicle, of the first scan
    std::string remarks;               ///< of the source: what was left out
    std::string damage;                ///< where the input ended too early; empty: it did not
};

/// @param turned  rotation of the sensor before its pose, e.g. half a turn about x: upside down.
/// @throws as openInput; UsageError if there are several lidars and none was chosen; std::runtime_error if there is no
///     scan.
Look lookAt(const Options& options, const DetectorParams& params, const mrpt::poses::CPose3D& turned = {});

/// The pose with which the ground would be level and at z = 0: "X,Y,Z,YAW,PITCH,ROLL" [m, deg] for --sensor-pose.
/// The place beside the height, and what of the rotation the ground does not tell, stay. The report has a height.
std::string levelPose(const Look& look);

}  // namespace lidar_obstacles::apps
