// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Steps of the simulated ground: kerbs, edges of sidewalks, ramps.
#pragma once

#include <cmath>
#include <optional>

#include "lidar_obstacles/simulation/world.h"
#include "sequence/zone_shape.h"

namespace lidar_obstacles::test {

/// Does the ground under a polygon of the vehicle frame, or within 0.5 m of it, rise or fall by more than 5 cm over 0.2
/// m?
inline bool hasStep(const simulation::World& world, const simulation::Pose6& ego, const ZonePolygon& polygon) {
    constexpr double kCell = 0.2, kNear = 0.5, kStep = 0.05;  // [m]
    const Eigen::Isometry3d T = simulation::toIsometry(ego);
    ZonePoint low(1e9, 1e9), high(-1e9, -1e9);
    for (const ZonePoint& p : polygon.outer()) {
        low = {std::min(low.x(), p.x()), std::min(low.y(), p.y())};
        high = {std::max(high.x(), p.x()), std::max(high.y(), p.y())};
    }
    const auto heightAt = [&](double x, double y) {
        return world.ground->heightAt((T * Eigen::Vector3d(x, y, 0.0)).head<2>());
    };
    for (double x = low.x() - kNear; x <= high.x() + kNear; x += kCell)
        for (double y = low.y() - kNear; y <= high.y() + kNear; y += kCell) {
            if (distance(polygon, Eigen::Vector2d(x, y)) > kNear) continue;
            const auto here = heightAt(x, y), ahead = heightAt(x + kCell, y), left = heightAt(x, y + kCell);
            for (const auto& there : {ahead, left})
                if (here && there && std::abs(*here - *there) > kStep) return true;
        }
    return false;
}

}  // namespace lidar_obstacles::test
