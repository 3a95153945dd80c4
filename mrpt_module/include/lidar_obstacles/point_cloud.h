// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One scan: its returns, their rays and their neighbourhood.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace lidar_obstacles {

/// Neighbourhood of a scan: for each ring (row, 0 = lowest elevation) and azimuth column the index of a return,
/// or -1. Columns run with rising column number in the direction the sensor turns and close to a full circle:
/// the last column is the neighbour of the first. Where two returns share a place the nearer one is listed.
/// Empty (`rings == 0`) for sources without ring numbers.
struct OrganizedView {
    int rings = 0;
    int columns = 0;
    std::vector<std::int32_t> index;      ///< rings x columns, row-major; -1 where there is no return
    std::vector<std::int32_t> column_of;  ///< column of each return of the cloud, also of those not listed in `index`

    bool empty() const { return rings == 0 || columns == 0; }
    std::int32_t at(int ring, int column) const { return index[static_cast<std::size_t>(ring) * columns + column]; }
    std::int32_t& at(int ring, int column) { return index[static_cast<std::size_t>(ring) * columns + column]; }
    /// `column` shifted by `step` around the circle.
    int wrap(int column) const {
        if (column >= 0 && column < columns) return column;
        return (column % columns + columns) % columns;
    }
};

/// One sensor of a cloud that several made: where its rays start, and which returns and rings are its own. The first
/// sensor has the first of them, each other one those behind the one before.
struct SensorRays {
    Eigen::Vector3f origin = Eigen::Vector3f::Zero();  ///< [m]
    Eigen::Vector3f up = Eigen::Vector3f::UnitZ();     ///< what its rings count along, unit length
    std::int32_t end = 0;                              ///< past its last return
    int end_ring = 0;                                  ///< past its highest ring
    int first_ring = 0;                                ///< its lowest
};

/// One lidar scan: N returns in the vehicle frame, all finite (the border drops the others).
/// `ring`, `intensity` and `time_offset` hold N entries each, or none where the source does not tell.
///
/// What several sensors saw at a time is one cloud too (joinedCloud() in joined_cloud.h): the rings of each sensor are
/// its own, columns look in the same direction from each.
struct PointCloud {
    double timestamp = 0.0;                                   ///< seconds since the epoch of the scan's first firing
    std::vector<Eigen::Vector3f> xyz;                         ///< [m]
    std::vector<std::uint16_t> ring;                          ///< 0 = lowest elevation
    std::vector<float> intensity;                             ///< 0 .. 1
    std::vector<float> time_offset;                           ///< seconds after `timestamp`
    OrganizedView view;                                       ///< ring x azimuth index; empty for sources without rings
    Eigen::Vector3f sensor_origin = Eigen::Vector3f::Zero();  ///< where the rays start
    Eigen::Vector3f sensor_up = Eigen::Vector3f::UnitZ();     ///< the sensor's z axis, unit length
    std::vector<SensorRays> sensors;  ///< of a joined cloud; `sensor_origin` is in their middle. Empty: one sensor

    std::size_t size() const { return xyz.size(); }
    bool empty() const { return xyz.empty(); }

    /// Number of the sensor of return i, from 0.
    std::size_t sensorOf(std::int32_t i) const {
        std::size_t s = 0;
        while (s + 1 < sensors.size() && i >= sensors[s].end) ++s;
        return s;
    }
    /// Where the ray of return i starts [m].
    const Eigen::Vector3f& originOf(std::int32_t i) const {
        return sensors.empty() ? sensor_origin : sensors[sensorOf(i)].origin;
    }
    /// All sensors; the one there is where the cloud was not joined.
    std::vector<SensorRays> allSensors() const {
        if (!sensors.empty()) return sensors;
        return {{sensor_origin, sensor_up, static_cast<std::int32_t>(size()), view.rings}};
    }
    /// The rings of the sensor that a ring belongs to: from this one, up to before endRing().
    int firstRing(int of_ring) const {
        int first = 0;
        for (const SensorRays& s : sensors) first = of_ring >= s.end_ring ? s.end_ring : first;
        return first;
    }
    int endRing(int of_ring) const {
        for (const SensorRays& s : sensors)
            if (of_ring < s.end_ring) return s.end_ring;
        return view.rings;
    }
    /// Where the rays of a ring start [m].
    const Eigen::Vector3f& originOfRing(int of_ring) const {
        for (const SensorRays& s : sensors)
            if (of_ring < s.end_ring) return s.origin;
        return sensor_origin;
    }
};

/// Throws std::invalid_argument if a coordinate is not finite (or beyond 100 km), the per-return vectors do not fit
/// each other, the view names rings, columns or returns that do not exist, or the sensors do not share all of them.
void validate(const PointCloud& cloud);

}  // namespace lidar_obstacles
