// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/observations.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mrpt_bridge/input/elevation_rings.h"
#include "mrpt_bridge/input/point_fields.h"
#include "mrpt_bridge/input/ring_order.h"
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

/// Rings of a sensor that only shows in its points.
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

/// The points of a scan in its own frame, with what is told of each.
struct SensorPoints {
    std::vector<Eigen::Vector3f> xyz;
    std::vector<float> intensity;     ///< empty: not told
    std::vector<float> time_offset;   ///< empty: not told
    std::vector<std::uint16_t> ring;  ///< empty: not told
    int rings = 0;                    ///< of the sensor; 0: not told
};

/// Rings that count upwards, whatever the source begins with.
void countRingsUpwards(SensorPoints& points) {
    const std::vector<int> number = ringsUpwards(points.xyz, points.ring, points.rings);
    if (number.empty()) return;
    for (std::uint16_t& ring : points.ring) ring = static_cast<std::uint16_t>(number[ring]);
}

/// Times of returns, unless one of them is of no turn.
void leaveOutWrongTimes(std::vector<float>& times, DecodeStats& stats) {
    stats.times_left_out = !std::all_of(times.begin(), times.end(), isTimeOfTurn);
    if (stats.times_left_out) times.clear();
}

/// Times count from the first return, and so does the cloud's stamp.
void countFromFirst(std::vector<float>& times, PointCloud& cloud) {
    const float first = *std::min_element(times.begin(), times.end());
    for (float& time : times) time -= first;
    cloud.timestamp += static_cast<double>(first);
}

/// Fills in rings where the scan tells none and the elevations do.
void recoverRings(const SensorParams& params, SensorPoints& points, DecodeStats& stats) {
    if (points.rings != 0) return countRingsUpwards(points);
    if (points.xyz.empty()) return;
    auto found = ringsFromElevations(points.xyz);
    if (found && (params.rings == 0 || found->rings <= params.rings)) {
        points.ring = std::move(found->ring);
        points.rings = params.rings != 0 ? params.rings : found->rings;
        return;
    }
    refuseDecimation(params);
    stats.without_rings = true;
}

/// The cloud in the vehicle's frame, with the rings that are to be kept.
PointCloud toVehicle(const SensorPoints& points, const SensorFrame& frame, const SensorParams& params,
                     PointCloud cloud) {
    const std::vector<int> new_ring = ringAfterDecimation(points.rings, points.rings == 0 ? 0 : params.planes);
    cloud.xyz.reserve(points.xyz.size());
    for (std::size_t i = 0; i < points.xyz.size(); ++i) {
        const int ring = points.rings == 0 ? 0 : new_ring[points.ring[i]];
        if (ring < 0) continue;
        cloud.xyz.push_back(frame.toVehicle(points.xyz[i]));
        if (points.rings != 0) cloud.ring.push_back(static_cast<std::uint16_t>(ring));
        if (!points.intensity.empty()) cloud.intensity.push_back(points.intensity[i]);
        if (!points.time_offset.empty()) cloud.time_offset.push_back(points.time_offset[i]);
    }
    if (points.rings != 0) buildRingView(frame, params.planes == 0 ? points.rings : params.planes, cloud);
    return cloud;
}

PointCloud fromPoints(const Velodyne& scan, const SensorParams& params, DecodeStats& stats) {
    const Velodyne::TPointCloud& all = scan.point_cloud;
    checkLengths(all);
    const SensorFrame frame = sensorFrame(scan.sensorPose);
    const RangeLimits limits = rangeLimits(params, scan.minRange, scan.maxRange);
    SensorPoints points;
    points.rings = countRings(all.laser_id, params);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Eigen::Vector3f p(all.x[i], all.y[i], all.z[i]);
        const float range = p.norm();
        if (range == 0.0f || !limits.contains(range)) continue;  // a range that is not finite is in no limits
        points.xyz.push_back(p);
        if (points.rings != 0) points.ring.push_back(static_cast<std::uint16_t>(all.laser_id[i]));
        if (!all.intensity.empty()) points.intensity.push_back(static_cast<float>(all.intensity[i]) / 255.0f);
        if (!all.timestamp.empty())
            points.time_offset.push_back(
                static_cast<float>(mrpt::system::timeDifference(scan.timestamp, all.timestamp[i])));
    }
    leaveOutWrongTimes(points.time_offset, stats);
    recoverRings(params, points, stats);
    PointCloud cloud = emptyCloud(frame, scan.timestamp);
    // MRPT stamps a scan by its first firing, others by its middle or its end
    const auto is_before = [](float time) { return time < 0.0f; };
    if (std::any_of(points.time_offset.begin(), points.time_offset.end(), is_before))
        countFromFirst(points.time_offset, cloud);
    return toVehicle(points, frame, params, std::move(cloud));
}

/// What the map tells of each point; what cannot be right is left out: rings of no lidar, times of no turn.
PointFields soundFieldsOf(const mrpt::maps::CPointsMap& map, DecodeStats& stats) {
    PointFields fields = pointFieldsOf(map);
    if (fields.intensity.empty()) fields.intensity = intensitiesOf(map);
    const auto is_no_ring = [](std::uint16_t ring) { return ring >= kMaxRings; };
    if (std::any_of(fields.ring.begin(), fields.ring.end(), is_no_ring)) fields.ring.clear();
    leaveOutWrongTimes(fields.time, stats);
    return fields;
}

SensorPoints pointsOfMap(const mrpt::maps::CPointsMap& map, const SensorParams& params, DecodeStats& stats) {
    const RangeLimits limits{params.min_range, params.max_range};
    const PointFields fields = soundFieldsOf(map, stats);
    SensorPoints points;
    points.xyz.reserve(map.size());
    if (!fields.ring.empty())
        points.rings = std::max(params.rings, 1 + *std::max_element(fields.ring.begin(), fields.ring.end()));
    for (std::size_t i = 0; i < map.size(); ++i) {
        float x, y, z;
        map.getPointFast(i, x, y, z);
        const Eigen::Vector3f p(x, y, z);
        const float range = p.norm();
        if (range == 0.0f || !limits.contains(range)) continue;
        points.xyz.push_back(p);
        if (!fields.intensity.empty())
            points.intensity.push_back(std::isfinite(fields.intensity[i]) ? fields.intensity[i] : 0.0f);
        if (!fields.time.empty()) points.time_offset.push_back(fields.time[i]);
        if (!fields.ring.empty()) points.ring.push_back(fields.ring[i]);
    }
    recoverRings(params, points, stats);
    return points;
}

}  // namespace

PointCloud toPointCloud(const Velodyne& scan, const SensorParams& params, DecodeStats* stats) {
    DecodeStats ignored;
    DecodeStats& counted = stats ? *stats : ignored;
    counted = DecodeStats{};
    return scan.scan_packets.empty() ? fromPoints(scan, params, counted) : decodePackets(scan, params, counted);
}

PointCloud toPointCloud(const mrpt::obs::CObservationPointCloud& scan, const SensorParams& params, DecodeStats* stats) {
    DecodeStats ignored;
    DecodeStats& counted = stats ? *stats : ignored;
    counted = DecodeStats{};
    const SensorFrame frame = sensorFrame(scan.sensorPose);
    PointCloud cloud = emptyCloud(frame, scan.timestamp);
    scan.load();  // clouds may be stored in a file of their own
    if (!scan.pointcloud) return cloud;
    SensorPoints points = pointsOfMap(*scan.pointcloud, params, counted);
    if (!points.time_offset.empty()) countFromFirst(points.time_offset, cloud);  // it may be stamped by another
    return toVehicle(points, frame, params, std::move(cloud));
}

std::optional<PointCloud> toPointCloud(const mrpt::obs::CObservation& observation, const SensorParams& params,
                                       DecodeStats* stats) {
    if (stats) *stats = DecodeStats{};
    if (const auto* scan = dynamic_cast<const Velodyne*>(&observation)) return toPointCloud(*scan, params, stats);
    if (const auto* scan = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&observation))
        return toPointCloud(*scan, params, stats);
    if (const auto* scan = dynamic_cast<const mrpt::obs::CObservationRotatingScan*>(&observation))
        return toPointCloud(*scan, params, stats);
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
