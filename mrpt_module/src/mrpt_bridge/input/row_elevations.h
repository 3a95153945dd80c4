// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the rows of a range image look: the observation names its sensor's model and no elevations.
#pragma once

#include <mrpt/obs/VelodyneCalibration.h>

#include <string>

namespace lidar_obstacles {

struct ImageRows {
    mrpt::obs::VelodyneCalibration lasers;  ///< behind the rows, in row order
    bool of_velodyne = false;
};

/// The lasers behind the rows of a range image.
///
/// Rows of Velodynes come as MRPT's converter writes them, in the order of the packets; those of the others are sorted
/// as their makers number them: RoboSense from the lowest, Hesai from the highest.
/// @param model  as the observation names it; letters and figures count alone: "VLP-16" and "velodyne vlp16" are the
/// same.
/// @return null if the model is not known.
const ImageRows* imageRows(const std::string& model);

/// The models that are known, for a message.
std::string modelsOfRows();

}  // namespace lidar_obstacles
