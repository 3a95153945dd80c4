// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/testing/find_obstacle.h"

#include <cmath>
#include <ostream>
#include <stdexcept>

#include "lidar_obstacles/testing/matchers.h"
#include "text.h"

namespace lidar_obstacles {

void PrintTo(const Obstacle& obstacle, std::ostream* os) { *os << testing::describe(obstacle); }

namespace testing {

// NOLINTNEXTLINE(readability-function-size): as declared
std::optional<Obstacle> findObstacle(const std::vector<Obstacle>& obstacles, ObstacleClass cls, double x, double y,
                                     double tolerance) {
    if (!(tolerance > 0.0)) throw std::invalid_argument("findObstacle: the tolerance must be a positive number");
    const Obstacle* best = nullptr;
    double nearest = tolerance;
    for (const Obstacle& o : obstacles) {
        const double distance = std::hypot(o.box.center.x() - x, o.box.center.y() - y);
        if (o.cls != cls || !(distance <= nearest)) continue;
        nearest = distance;
        best = &o;
    }
    return best == nullptr ? std::nullopt : std::optional<Obstacle>(*best);
}

std::string describe(const Obstacle& o) {
    const Eigen::Vector3d& size = o.box.size;
    std::string text = std::string(toString(o.cls)) + " " + std::to_string(o.id) + " at " +
                       place(o.box.center.x(), o.box.center.y()) + ", " + number(size.x()) + " x " + number(size.y()) +
                       " x " + number(size.z()) + " m, ";
    text += o.heading_valid ? "heading " + degrees(o.box.yaw) : "no heading";
    if (o.track && o.track->velocity) text += ", " + number(o.track->velocity->norm()) + " m/s";
    return text + ", " + std::to_string(o.num_points) + " returns";
}

}  // namespace testing
}  // namespace lidar_obstacles
