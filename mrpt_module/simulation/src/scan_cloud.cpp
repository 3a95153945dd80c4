// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "firings.h"
#include "lidar_obstacles/simulation/lasers.h"
#include "lidar_obstacles/simulation/truth.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kDistanceUnit = 0.002;  ///< of LidarReturn::raw [m]

/// New number of each ring that stays, -1 for the others.
std::vector<int> numbersOfRings(const std::vector<Laser>& lasers, int rings) {
    std::vector<double> rising;
    for (const Laser& laser : lasers) rising.push_back(laser.elevation);
    std::sort(rising.begin(), rising.end());
    const std::vector<double> kept = rings == 0 ? rising : decimated(rising, rings);
    std::vector<int> numbers;
    for (double elevation : rising) {
        const auto at = std::find(kept.begin(), kept.end(), elevation);
        numbers.push_back(at == kept.end() ? -1 : static_cast<int>(at - kept.begin()));
    }
    return numbers;
}

}  // namespace

ScanCloud toCloud(const LidarScan& scan, const SensorSpec& sensor, int rings) {
    const std::vector<Laser> lasers = lasersOf(sensor);
    const std::vector<int> number = numbersOfRings(lasers, rings);
    const Eigen::Isometry3d T_vehicle_sensor = toIsometry(sensor.pose);
    ScanCloud result;
    PointCloud& cloud = result.cloud;
    cloud.timestamp = kEpoch + scan.turn.start();
    cloud.sensor_origin = T_vehicle_sensor.translation().cast<float>();
    cloud.sensor_up = T_vehicle_sensor.linear().col(2).cast<float>();
    cloud.view.rings = *std::max_element(number.begin(), number.end()) + 1;
    cloud.view.columns = scan.turn.packets * kFiringsPerPacket;
    cloud.view.index.assign(static_cast<std::size_t>(cloud.view.rings) * cloud.view.columns, -1);
    for (std::size_t i = 0; i < scan.returns.size(); ++i) {
        const LidarReturn& r = scan.returns[i];
        const Laser& laser = lasers[r.laser];
        const int ring = number[static_cast<std::size_t>(laser.ring)];
        if (ring < 0) continue;
        const double time = scan.turn.start() + static_cast<double>(r.time);
        const Eigen::Vector3d direction = directionOf(laser.elevation, time, sensor.rate);
        cloud.view.at(ring, r.firing) = static_cast<std::int32_t>(cloud.size());
        cloud.view.column_of.push_back(r.firing);
        cloud.xyz.push_back((T_vehicle_sensor * (kDistanceUnit * r.raw * direction)).cast<float>());
        cloud.ring.push_back(static_cast<std::uint16_t>(ring));
        cloud.intensity.push_back(static_cast<float>(r.intensity) / 255.0f);
        cloud.time_offset.push_back(r.time);
        result.source.push_back(static_cast<std::int32_t>(i));
    }
    return result;
}

}  // namespace lidar_obstacles::simulation
