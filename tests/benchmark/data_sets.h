// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The scans that are timed.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::bench {

struct DataSet {
    std::string name;
    PointCloud cloud;
    mrpt::obs::CObservationVelodyneScan::Ptr packets;  ///< null where the set holds no packets
};

/// A synthetic street seen by 16, 32 and 64 planes, Debian's sample scan and, if LIDAR_OBSTACLES_DATA names the folder
/// of the labelled data, one scan of kitti_0001_16, also decimated to 8 planes. Sets whose file is not there are left
/// out.
std::vector<DataSet> loadDataSets();

}  // namespace lidar_obstacles::bench
