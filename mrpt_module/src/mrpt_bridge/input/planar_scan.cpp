// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "mrpt_bridge/input/ring_view.h"
#include "mrpt_bridge/input/sensor_frame.h"

namespace lidar_obstacles {

PointCloud toPointCloud(const mrpt::obs::CObservation2DRangeScan& scan, const SensorParams& params) {
    if (params.planes > 1)
        throw std::invalid_argument("[sensor] planes = " + std::to_string(params.planes) +
                                    ", but a CObservation2DRangeScan has one plane");
    const SensorFrame frame = sensorFrame(scan.sensorPose);
    const double aperture = scan.aperture;
    if (!(aperture > 0.0 && aperture < 2.1 * M_PI)) throw std::runtime_error("the scan's aperture cannot be right");
    const RangeLimits limits = rangeLimits(params, 0.0, scan.maxRange);
    const std::size_t rays = scan.getScanSize();
    const double step = rays > 1 ? aperture / static_cast<double>(rays - 1) : 0.0;
    PointCloud cloud = emptyCloud(frame, scan.timestamp);
    for (std::size_t k = 0; k < rays; ++k) {
        const float range = scan.getScanRange(k);
        if (!scan.getScanRangeValidity(k) || range == 0.0f || !limits.contains(range)) continue;
        const double left = -0.5 * aperture + static_cast<double>(k) * step;
        const auto azimuth = static_cast<float>(scan.rightToLeft ? left : -left);
        cloud.xyz.push_back(frame.toVehicle({range * std::cos(azimuth), range * std::sin(azimuth), 0.0f}));
        cloud.ring.push_back(0);
    }
    buildRingView(frame, 1, cloud);
    return cloud;
}

}  // namespace lidar_obstacles
