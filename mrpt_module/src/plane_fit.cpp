#include "lidar_obstacles/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace lidar_obstacles {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Vec2 = Eigen::Vector2d;

/// A vertical plane seen from above: points p with normal . p = offset; the normal points to the sensor.
struct Face {
    Vec2 normal = Vec2::Zero();
    double offset = 0.0;
    int support = 0;
};

std::vector<Vec2> footprint(const Cluster& cluster, const PointCloud& cloud) {
    std::vector<Vec2> points;
    points.reserve(cluster.points.size());
    for (const std::int32_t i : cluster.points) points.push_back(cloud.xyz[i].head<2>().cast<double>());
    return points;
}

int countInliers(const std::vector<Vec2>& points, const Face& face, double distance) {
    int n = 0;
    for (const Vec2& p : points) n += std::abs(face.normal.dot(p) - face.offset) < distance;
    return n;
}

Face leastSquaresFace(const std::vector<Vec2>& points, const Face& start, double distance) {
    Vec2 mean = Vec2::Zero();
    Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
    int n = 0;
    for (const Vec2& p : points) {
        if (std::abs(start.normal.dot(p) - start.offset) >= distance) continue;
        mean += p;
        m += p * p.transpose();
        ++n;
    }
    if (n < 3) return start;
    mean /= n;
    const Eigen::Matrix2d cov = m / n - mean * mean.transpose();
    const double along = 0.5 * std::atan2(2.0 * cov(0, 1), cov(0, 0) - cov(1, 1));
    Face face;
    face.normal = Vec2(-std::sin(along), std::cos(along));
    if (face.normal.dot(start.normal) < 0.0) face.normal = -face.normal;
    face.offset = face.normal.dot(mean);
    face.support = n;
    return face;
}

Face ransacFace(const std::vector<Vec2>& points, const Vec2& to_sensor, const PlaneFitParams& params) {
    std::mt19937 random(static_cast<std::uint32_t>(params.seed));
    const double min_cos = std::cos(params.max_facing_deg * kPi / 180.0);
    Face best;
    for (int k = 0; k < params.ransac_iterations; ++k) {
        const Vec2& a = points[random() % points.size()];
        const Vec2& b = points[random() % points.size()];
        const Vec2 d = b - a;
        if (d.squaredNorm() < 0.01) continue;
        Face face;
        face.normal = Vec2(-d.y(), d.x()).normalized();
        if (face.normal.dot(to_sensor) < 0.0) face.normal = -face.normal;
        if (face.normal.dot(to_sensor) < min_cos) continue;
        face.offset = face.normal.dot(a);
        face.support = countInliers(points, face, params.inlier_distance);
        if (face.support > best.support) best = face;
    }
    for (int k = 0; k < 3 && best.support > 0; ++k) best = leastSquaresFace(points, best, params.inlier_distance);
    return best;
}

struct Range1 {
    double min = 1e9;
    double max = -1e9;
    void add(double v) {
        min = std::min(min, v);
        max = std::max(max, v);
    }
    double size() const { return max - min; }
    double mid() const { return 0.5 * (min + max); }
};

void setHeights(const Cluster& cluster, const GroundModel& ground, Obstacle& o) {
    float top = 0.1f;
    for (const std::int32_t i : cluster.points) top = std::max(top, ground.height[i]);
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

}  // namespace

Obstacle fitPlaneBox(const Cluster& cluster, const PointCloud& cloud, const GroundModel& ground,
                     const PlaneFitParams& params) {
    if (cluster.points.empty()) throw std::invalid_argument("fitPlaneBox: a cluster without returns");
    const std::vector<Vec2> points = footprint(cluster, cloud);
    Vec2 mean = Vec2::Zero();
    for (const Vec2& p : points) mean += p / static_cast<double>(points.size());
    const Vec2 to_sensor = (cloud.sensor_origin.head<2>().cast<double>() - mean).normalized();
    const Face face = ransacFace(points, to_sensor, params);
    Obstacle o;
    o.num_points = static_cast<int>(points.size());
    o.num_rings = countRings(cluster, cloud);
    o.points = cluster.points;
    const Vec2 normal = face.support >= 3 ? face.normal : to_sensor;
    const Vec2 along(-normal.y(), normal.x());
    Range1 depth;
    Range1 width;
    for (const Vec2& p : points) {
        depth.add(normal.dot(p));
        width.add(along.dot(p));
    }
    const bool face_is_side = width.size() > params.max_rear_width && width.size() > depth.size();
    const Vec2 forward = face_is_side ? along : -normal;
    o.box.yaw = normalizeAngle(std::atan2(forward.y(), forward.x()));
    o.heading_valid = face.support >= 3;
    const Vec2 center = depth.mid() * normal + width.mid() * along;
    o.box.center.head<2>() = center;
    o.box.size.head<2>() = face_is_side ? Vec2(width.size(), depth.size()) : Vec2(depth.size(), width.size());
    o.box.size.head<2>() = o.box.size.head<2>().cwiseMax(0.1);
    setHeights(cluster, ground, o);
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
    if (length <= p.person_max_size && height >= p.person_min_height && height <= p.person_max_height)
        return ObstacleClass::Pedestrian;
    if (length >= p.vehicle_min_length && length <= p.vehicle_max_length && width <= p.vehicle_max_width)
        return ObstacleClass::Vehicle;
    return ObstacleClass::Unknown;
}

}  // namespace lidar_obstacles
