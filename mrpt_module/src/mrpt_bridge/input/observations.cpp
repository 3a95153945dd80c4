#include "lidar_obstacles/mrpt_bridge/observations.h"

#include <mrpt/maps/CPointsMapXYZI.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mrpt_bridge/input/ring_view.h"
#include "mrpt_bridge/input/sensor_frame.h"
#include "mrpt_bridge/input/velodyne_decoder.h"

namespace lidar_obstacles {
namespace {

using Velodyne = mrpt::obs::CObservationVelodyneScan;

void checkLengths(const Velodyne::TPointCloud& points) {
    const std::size_t n = points.x.size();
    const auto fits = [n](std::size_t length) { return length == 0 || length == n; };
    if (points.y.size() != n || points.z.size() != n || !fits(points.intensity.size()) ||
        !fits(points.laser_id.size()) || !fits(points.timestamp.size()))
        throw std::runtime_error("the fields of the scan's point_cloud have different lengths");
}

/// Planes of a sensor that only shows in its points.
/// @throws std::runtime_error if a ring number cannot be right, std::invalid_argument if `params.rings` is too small.
int countRings(const std::vector<std::int16_t>& laser_id, const SensorParams& params) {
    if (laser_id.empty()) return 0;
    const auto [low, high] = std::minmax_element(laser_id.begin(), laser_id.end());
    if (*low < 0 || *high >= kMaxRings)
        throw std::runtime_error("the scan's laser_id " + std::to_string(*low < 0 ? *low : *high) +
                                 " is no ring of a lidar");
    if (params.rings != 0 && *high >= params.rings)
        throw std::invalid_argument("[sensor] rings = " + std::to_string(params.rings) +
                                    ", but the scan has laser_id " + std::to_string(*high));
    return params.rings != 0 ? params.rings : *high + 1;
}

void refuseDecimation(const SensorParams& params) {
    if (params.planes != 0)
        throw std::invalid_argument("[sensor] planes = " + std::to_string(params.planes) +
                                    ", but the scan has no ring numbers to choose from");
}

PointCloud fromPoints(const Velodyne& scan, const SensorParams& params) {
    const Velodyne::TPointCloud& points = scan.point_cloud;
    checkLengths(points);
    const SensorFrame frame = sensorFrame(scan.sensorPose);
    const RangeLimits limits = rangeLimits(params, scan.minRange, scan.maxRange);
    const int rings = countRings(points.laser_id, params);
    if (rings == 0 && !points.x.empty()) refuseDecimation(params);
    const std::vector<int> new_ring = ringAfterDecimation(rings, rings == 0 ? 0 : params.planes);

    PointCloud cloud = emptyCloud(frame, scan.timestamp);
    cloud.xyz.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3f p(points.x[i], points.y[i], points.z[i]);
        const int ring = rings == 0 ? 0 : new_ring[static_cast<std::size_t>(points.laser_id[i])];
        const float range = p.norm();
        if (ring < 0 || range == 0.0f || !limits.contains(range))
            continue;  // a range that is not finite is in no limits
        cloud.xyz.push_back(frame.toVehicle(p));
        if (rings != 0) cloud.ring.push_back(static_cast<std::uint16_t>(ring));
        if (!points.intensity.empty()) cloud.intensity.push_back(static_cast<float>(points.intensity[i]) / 255.0f);
        if (!points.timestamp.empty())
            cloud.time_offset.push_back(
                static_cast<float>(mrpt::system::timeDifference(scan.timestamp, points.timestamp[i])));
    }
    if (rings != 0) buildRingView(frame, params.planes == 0 ? rings : params.planes, cloud);
    return cloud;
}

}  // namespace

PointCloud toPointCloud(const Velodyne& scan, const SensorParams& params, DecodeStats* stats) {
    DecodeStats ignored;
    DecodeStats& counted = stats ? *stats : ignored;
    counted = DecodeStats{};
    return scan.scan_packets.empty() ? fromPoints(scan, params) : decodePackets(scan, params, counted);
}

PointCloud toPointCloud(const mrpt::obs::CObservationPointCloud& scan, const SensorParams& params) {
    refuseDecimation(params);
    const SensorFrame frame = sensorFrame(scan.sensorPose);
    PointCloud cloud = emptyCloud(frame, scan.timestamp);
    scan.load();  // clouds may be stored in a file of their own
    if (!scan.pointcloud) return cloud;
    const mrpt::maps::CPointsMap& points = *scan.pointcloud;
    const RangeLimits limits{params.min_range, params.max_range};
    cloud.xyz.reserve(points.size());
    const auto* with_intensity = dynamic_cast<const mrpt::maps::CPointsMapXYZI*>(&points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        float x, y, z;
        points.getPointFast(i, x, y, z);
        const Eigen::Vector3f p(x, y, z);
        const float range = p.norm();
        const float intensity = with_intensity ? with_intensity->getPointIntensity_fast(i) : 0.0f;
        if (range == 0.0f || !limits.contains(range) || !std::isfinite(intensity)) continue;
        cloud.xyz.push_back(frame.toVehicle(p));
        if (with_intensity) cloud.intensity.push_back(intensity);
    }
    return cloud;
}

std::optional<PointCloud> toPointCloud(const mrpt::obs::CObservation& observation, const SensorParams& params,
                                       DecodeStats* stats) {
    if (stats) *stats = DecodeStats{};
    if (const auto* scan = dynamic_cast<const Velodyne*>(&observation)) return toPointCloud(*scan, params, stats);
    if (const auto* scan = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation))
        return toPointCloud(*scan, params);
    if (const auto* scan = dynamic_cast<const mrpt::obs::CObservationRotatingScan*>(&observation))
        return toPointCloud(*scan, params);
    if (const auto* scan = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation))
        return toPointCloud(*scan, params);
    return std::nullopt;
}

bool isLidarScan(const mrpt::obs::CObservation& observation) {
    return dynamic_cast<const Velodyne*>(&observation) != nullptr ||
           dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation) != nullptr ||
           dynamic_cast<const mrpt::obs::CObservationRotatingScan*>(&observation) != nullptr ||
           dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&observation) != nullptr;
}

}  // namespace lidar_obstacles
