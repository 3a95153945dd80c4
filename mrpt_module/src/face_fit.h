#pragma once

#include <Eigen/Core>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Rectangle in the plane: p = u * (cos a, sin a) + v * (-sin a, cos a) with u, v inside the limits [m].
struct Rectangle {
    double angle = 0.0;      ///< of the u axis [rad]
    double angle_std = 0.0;  ///< standard deviation of the angle from the returns on the faces [rad]
    double u_min = 0.0, u_max = 0.0, v_min = 0.0, v_max = 0.0;
    double u_seen = 0.0;  ///< how far the nearer face across u is turned to the sensor: 0 (grazing or away) .. 1
    double v_seen = 0.0;  ///< the same for v
    int support = 0;      ///< returns on the seen faces

    double size_u() const { return u_max - u_min; }
    double size_v() const { return v_max - v_min; }
    Eigen::Vector2d center() const {
        const double u = 0.5 * (u_min + u_max);
        const double v = 0.5 * (v_min + v_max);
        return {u * std::cos(angle) - v * std::sin(angle), u * std::sin(angle) + v * std::cos(angle)};
    }
};

/// The rectangle around a cluster's returns whose seen faces lie on them (Sec. III.A, Fig. 3).
Rectangle fitRectangle(const Cluster& cluster, const PointCloud& cloud, const PlaneFitParams& params);

}  // namespace lidar_obstacles
