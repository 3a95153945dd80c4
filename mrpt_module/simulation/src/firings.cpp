// SPDX-License-Identifier: BSD-3-Clause
#include "firings.h"

#include "lidar_obstacles/simulation/lasers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_obstacles::simulation {
namespace {

/// Directions in which an object may be seen: a part of the circle about `azimuth`, counter-clockwise from x.
struct Window {
    double azimuth = 0.0, half_width = M_PI;
    double low = -M_PI, high = M_PI;  ///< elevation

    bool hasAzimuth(double a) const { return std::abs(std::remainder(a - azimuth, 2.0 * M_PI)) <= half_width; }
    bool hasElevation(double e) const { return e >= low && e <= high; }
};

/// Seen from the sensor at `T_sensor_object`; with room for the motion within a turn.
Window windowOf(const Eigen::Isometry3d& T_sensor_object, const Eigen::Vector3d& size) {
    constexpr double kRoom = 0.10;  // [rad]
    Window window;
    const Eigen::Vector3d center = T_sensor_object * Eigen::Vector3d(0.0, 0.0, 0.5 * size.z());
    if (center.head<2>().norm() < size.head<2>().norm() + 2.0) return window;  // all around
    window.azimuth = std::atan2(center.y(), center.x());
    window.half_width = 0.0;
    window.low = M_PI, window.high = -M_PI;
    for (int k = 0; k < 8; ++k) {
        const Eigen::Vector3d corner((k & 1) ? 0.5 : -0.5, (k & 2) ? 0.6 : -0.6, (k & 4) ? 1.0 : 0.0);
        const Eigen::Vector3d p = T_sensor_object * corner.cwiseProduct(size);
        const double side = std::abs(std::remainder(std::atan2(p.y(), p.x()) - window.azimuth, 2.0 * M_PI));
        window.half_width = std::max(window.half_width, side);
        const double elevation = std::atan2(p.z(), p.head<2>().norm());
        window.low = std::min(window.low, elevation);
        window.high = std::max(window.high, elevation);
    }
    window.half_width += kRoom;
    window.low -= kRoom;
    window.high += kRoom;
    return window;
}

}  // namespace

Eigen::Isometry3d mountedPose(const SensorSpec& sensor) {
    return toIsometry(sensor.pose) * toIsometry(sensor.mount_error);
}

Eigen::Vector3d directionOf(double elevation, double t, double rate) {
    const double azimuth = 2.0 * M_PI * turnsAt(t, rate);
    return {std::cos(elevation) * std::cos(azimuth), -std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

std::vector<Firing> firingsOf(const World& world, const Turn& turn, const PoseTrack& ego) {
    const Eigen::Isometry3d T_vehicle_sensor = mountedPose(world.scenario.sensor);
    std::vector<Firing> firings;
    for (int f = 0; f < turn.packets * kFiringsPerPacket; ++f) {
        const double time = turn.start() + f * kFiringPeriod;
        firings.push_back({time, toIsometry(ego.at(time)) * T_vehicle_sensor});
    }
    return firings;
}

int countAlone(const World& world, const std::vector<Firing>& firings, const WorldObject& object,
               const PoseTrack& poses) {
    const SensorSpec& sensor = world.scenario.sensor;
    const Firing& middle = firings[firings.size() / 2];
    const Window window =
        windowOf(middle.T_world_sensor.inverse() * toIsometry(poses.at(middle.time)), object.model->size);
    const RayMesh& mesh = object.postures[postureAt(object, middle.time)];
    const std::vector<Laser> lasers = lasersOf(sensor);
    int count = 0;
    for (const Firing& firing : firings) {
        if (!window.hasAzimuth(-2.0 * M_PI * turnsAt(firing.time, sensor.rate))) continue;
        const Eigen::Isometry3d T_object_sensor = toIsometry(poses.at(firing.time)).inverse() * firing.T_world_sensor;
        const Eigen::Vector3f origin = T_object_sensor.translation().cast<float>();
        for (const Laser& laser : lasers) {
            if (!laser.active || !window.hasElevation(laser.elevation)) continue;
            const Eigen::Vector3d direction =
                T_object_sensor.linear() * directionOf(laser.elevation, firing.time + laser.delay, sensor.rate);
            if (mesh.distance(origin, direction.cast<float>(), static_cast<float>(sensor.max_range))) ++count;
        }
    }
    return count;
}

}  // namespace lidar_obstacles::simulation
