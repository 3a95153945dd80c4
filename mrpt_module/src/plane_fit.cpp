#include "lidar_obstacles/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "face_fit.h"

namespace lidar_obstacles {
namespace {

constexpr double kHalfTurn = 3.14159265358979323846;
constexpr double kMaxHeadingStd = 0.35;  // 20 deg: a direction known worse than that is none

void setHeights(const Cluster& cluster, const GroundModel& ground, Obstacle& o) {
    const double top = std::max(0.1f, cluster.top);
    const double bottom = ground.heightAt(o.box.center.x(), o.box.center.y());
    o.box.size.z() = top;
    o.box.center.z() = bottom + 0.5 * top;
}

int countRings(const Cluster& cluster, const PointCloud& cloud) {
    if (cloud.ring.empty()) return 0;
    std::vector<bool> seen;
    for (const std::int32_t i : cluster.points) {
        if (cloud.ring[i] >= seen.size()) seen.resize(cloud.ring[i] + 1);
        seen[cloud.ring[i]] = true;
    }
    return static_cast<int>(std::count(seen.begin(), seen.end(), true));
}

/// How badly the extent of a face fits a vehicle's length (or width): what is too much, and what is missing as far as
/// the face is turned to the sensor (`seen`, 0 .. 1) [m].
double misfit(double extent, double shortest, double longest, double seen) {
    return std::max(0.0, extent - longest) + seen * std::max(0.0, shortest - extent);
}

/// Which of the rectangle's axes is the vehicle's length? A face as wide as a rear is a rear, however little of the
/// side is seen: the heading is then its normal (Sec. III.A), not the longer side of the box.
bool lengthIsAlongU(const Rectangle& r, double height, const PlaneFitParams& params) {
    const double widest = height > params.tall ? params.max_rear_width : params.max_car_width;
    const auto cost = [&](double length, double length_seen, double width, double width_seen) {
        return misfit(length, params.min_vehicle_length, 100.0, length_seen) +
               misfit(width, params.min_rear_width, widest, width_seen) + 2.0 * std::max(0.0, width - widest);
    };
    // the face across v (at its edge in v) shows the extent along u, and the other way round
    return cost(r.size_u(), r.v_seen, r.size_v(), r.u_seen) < cost(r.size_v(), r.u_seen, r.size_u(), r.v_seen);
}

}  // namespace

Obstacle fitPlaneBox(const Cluster& cluster, const PointCloud& cloud, const GroundModel& ground,
                     const PlaneFitParams& params) {
    if (cluster.points.empty()) throw std::invalid_argument("fitPlaneBox: a cluster without returns");
    const Rectangle r = fitRectangle(cluster, cloud, params);
    Obstacle o;
    o.num_points = static_cast<int>(cluster.points.size());
    o.num_rings = countRings(cluster, cloud);
    o.points = cluster.points;
    o.box.center.head<2>() = r.center();
    setHeights(cluster, ground, o);
    const bool along_u = lengthIsAlongU(r, o.box.size.z(), params);
    const Eigen::Vector2d u(std::cos(r.angle), std::sin(r.angle));
    Eigen::Vector2d forward = along_u ? u : Eigen::Vector2d(-u.y(), u.x());
    if (forward.x() < 0.0) forward = -forward;  // the half turn is not seen: told in the direction of travel
    o.box.yaw = normalizeAngle(std::atan2(forward.y(), forward.x()));
    o.box.size.x() = along_u ? r.size_u() : r.size_v();
    o.box.size.y() = along_u ? r.size_v() : r.size_u();
    o.heading_valid = r.support >= 3 && r.angle_std < kMaxHeadingStd;
    if (!o.heading_valid && o.box.size.x() < o.box.size.y()) {
        std::swap(o.box.size.x(), o.box.size.y());
        o.box.yaw = normalizeAngle(o.box.yaw + kHalfTurn / 2);
    }
    o.heading_std = o.heading_valid ? r.angle_std : 0.0;
    return o;
}

std::vector<Obstacle> fitPlaneBoxes(const PointCloud& cloud, const std::vector<Cluster>& clusters,
                                    const GroundModel& ground, const PlaneFitParams& params) {
    std::vector<Obstacle> obstacles;
    obstacles.reserve(clusters.size());
    for (const Cluster& c : clusters) obstacles.push_back(fitPlaneBox(c, cloud, ground, params));
    return obstacles;
}

ObstacleClass classify(const Obstacle& o, const ClassParams& p) {
    const double length = std::max(o.box.size.x(), o.box.size.y());
    const double width = std::min(o.box.size.x(), o.box.size.y());
    const double height = o.box.size.z();
    const bool upright = height >= p.person_min_height && height <= p.person_max_height;
    if (length <= p.person_max_size && upright) return ObstacleClass::Pedestrian;
    if (length <= p.cyclist_max_length && width <= p.cyclist_max_width && upright && height >= p.cyclist_min_height)
        return ObstacleClass::Cyclist;
    if (length >= p.vehicle_min_length && length <= p.vehicle_max_length && width <= p.vehicle_max_width)
        return ObstacleClass::Vehicle;
    return ObstacleClass::Unknown;
}

}  // namespace lidar_obstacles
