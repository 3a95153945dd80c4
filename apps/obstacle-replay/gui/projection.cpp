// SPDX-License-Identifier: BSD-3-Clause
#include "projection.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_obstacles::apps {
namespace {

constexpr double kFov = 30.0 * M_PI / 180.0;
constexpr float kNear = 12.F;  ///< a click this near to the middle of a box means it [pixels]

/// How far along the ray it enters the box; none if it passes by.
std::optional<double> distanceInto(const OrientedBox& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
    const Eigen::AngleAxisd back(-box.yaw, Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d p = back * (from - box.center);
    const Eigen::Vector3d d = back * ray;
    double first = 0.0, last = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const double half = 0.5 * box.size[k];
        if (std::abs(d[k]) < 1e-12) {
            if (std::abs(p[k]) > half) return std::nullopt;
            continue;
        }
        const double a = (-half - p[k]) / d[k], b = (half - p[k]) / d[k];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    if (first > last) return std::nullopt;
    return first;
}

}  // namespace

Projection::Projection(const CameraPlace& camera, const ScreenRect& scene) : scene_(scene) {
    const double azimuth = camera.azimuth_deg * M_PI / 180.0;
    const double elevation = camera.elevation_deg * M_PI / 180.0;
    const Eigen::Vector3d out(std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
                              std::sin(elevation));
    eye_ = Eigen::Vector3d(camera.x, camera.y, camera.z) + std::max(0.01F, camera.distance) * out;
    ahead_ = -out;
    right_ = Eigen::Vector3d(-std::sin(azimuth), std::cos(azimuth), 0.0);
    up_ = right_.cross(ahead_);
    scale_ = 0.5 * scene.height / std::tan(0.5 * kFov);
}

std::optional<Eigen::Vector2f> Projection::pixelOf(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d d = point - eye_;
    const double depth = d.dot(ahead_);
    if (depth < 0.1) return std::nullopt;
    return Eigen::Vector2f(scene_.x + 0.5F * scene_.width + static_cast<float>(scale_ * d.dot(right_) / depth),
                           scene_.y + 0.5F * scene_.height - static_cast<float>(scale_ * d.dot(up_) / depth));
}

Eigen::Vector3d Projection::rayThrough(float x, float y) const {
    const double across = (x - scene_.x - 0.5 * scene_.width) / scale_;
    const double above = -(y - scene_.y - 0.5 * scene_.height) / scale_;
    return (ahead_ + across * right_ + above * up_).normalized();
}

std::optional<std::size_t> obstacleAt(const std::vector<Obstacle>& obstacles, const Projection& projection, float x,
                                      float y) {
    std::optional<std::size_t> hit;
    double nearest = std::numeric_limits<double>::infinity();
    const Eigen::Vector3d ray = projection.rayThrough(x, y);
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        const auto distance = distanceInto(obstacles[k].box, projection.eye(), ray);
        if (!distance || *distance >= nearest) continue;
        nearest = *distance;
        hit = k;
    }
    if (hit) return hit;
    float closest = kNear;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        const auto middle = projection.pixelOf(obstacles[k].box.center);
        const float away = middle ? (*middle - Eigen::Vector2f(x, y)).norm() : kNear;
        if (away >= closest) continue;
        closest = away;
        hit = k;
    }
    return hit;
}

}  // namespace lidar_obstacles::apps
