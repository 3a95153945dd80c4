// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_halves.h"

#include <algorithm>
#include <optional>

#include "lidar_obstacles/classification.h"
#include "objects/box.h"

namespace lidar_obstacles {
namespace {

constexpr double kLorry = 2.2;    // lower vehicles have no halves [m]
constexpr double kDrawbar = 2.0;  // between a lorry and its trailer [m]
constexpr double kAside = 0.5;    // how far a trailer runs beside the track of its lorry [m]
constexpr double kSpeed = 1.0;    // error of two speeds [m/s]

/// Place of a point from the middle of a box, along and across it [m].
Eigen::Vector2d placeIn(const OrientedBox& box, const Eigen::Vector2d& p) {
    const Eigen::Vector2d d = p - box.center.head<2>();
    return {d.dot(axisOf(box, 0)), d.dot(axisOf(box, 1))};
}

/// What a box covers, along and across another one [m].
Eigen::AlignedBox2d boundsIn(const OrientedBox& other, const OrientedBox& box) {
    Eigen::AlignedBox2d bounds;
    const Eigen::Vector2d along = 0.5 * box.size.x() * axisOf(box, 0), across = 0.5 * box.size.y() * axisOf(box, 1);
    for (const double end : {-1.0, 1.0})
        for (const double side : {-1.0, 1.0})
            bounds.extend(placeIn(other, box.center.head<2>() + end * along + side * across));
    return bounds;
}

/// The box around two that stand like the halves of one vehicle.
std::optional<OrientedBox> boxOfBoth(const OrientedBox& a, const OrientedBox& b) {
    if (std::min(a.size.z(), b.size.z()) < kLorry) return std::nullopt;
    OrientedBox whole = a.size.x() >= b.size.x() ? a : b;
    const Eigen::AlignedBox2d of_a = boundsIn(whole, a), of_b = boundsIn(whole, b), both = of_a.merged(of_b);
    const double gap = std::max(of_a.min().x(), of_b.min().x()) - std::min(of_a.max().x(), of_b.max().x());
    if (gap > kDrawbar || both.sizes().y() > std::max(of_a.sizes().y(), of_b.sizes().y()) + kAside) return std::nullopt;
    const Eigen::Vector2d middle = both.center();
    whole.center.head<2>() += middle.x() * axisOf(whole, 0) + middle.y() * axisOf(whole, 1);
    whole.size.head<2>() = both.sizes();
    return whole;
}

bool isSurelyVehicle(const ExpectedObject& o) {
    constexpr float kSure = 0.9f;
    return o.classes[static_cast<std::size_t>(ObstacleClass::Vehicle)] > kSure;
}

bool stands(const ExpectedObject& o, const OrientedBox& box) {
    const Eigen::Vector2d place = placeIn(box, o.box.center.head<2>());
    return (place.array().abs() < 0.5 * box.size.head<2>().array()).all();
}

}  // namespace

void addWholes(std::vector<ExpectedObject>& objects, const std::vector<Eigen::Vector2d>& velocities) {
    const std::vector<ExpectedObject> followed = objects;
    for (std::size_t i = 0; i < followed.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const ExpectedObject &a = followed[i], &b = followed[j];
            if (!isSurelyVehicle(a) || !isSurelyVehicle(b) || (velocities[i] - velocities[j]).norm() > kSpeed) continue;
            const std::optional<OrientedBox> box = boxOfBoth(a.box, b.box);
            const auto within = [&](const ExpectedObject& o) { return stands(o, *box); };
            if (!box || std::count_if(followed.begin(), followed.end(), within) > 2) continue;  // more than the halves
            objects.push_back({*box, std::max(a.std, b.std), a.classes, 2});
        }
}

}  // namespace lidar_obstacles
