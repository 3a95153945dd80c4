// SPDX-License-Identifier: BSD-3-Clause
#include "scene_site.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lidar_obstacles::simulation {
namespace {

/// Distance between the shadows of two boxes on the sides of `a`, the larger one; negative where both overlap.
double gapAlongSidesOf(const Footprint& a, const Footprint& b) {
    double gap = -1e9;
    const Eigen::Vector2d offset = b.center - a.center;
    for (int k = 0; k < 2; ++k) {
        const double angle = a.yaw + 0.5 * M_PI * k, turn = b.yaw - angle;
        const Eigen::Vector2d axis(std::cos(angle), std::sin(angle));
        const double reach = b.half.x() * std::abs(std::cos(turn)) + b.half.y() * std::abs(std::sin(turn));
        gap = std::max(gap, std::abs(offset.dot(axis)) - a.half[k] - reach);
    }
    return gap;
}

}  // namespace

bool meet(const Footprint& a, const Footprint& b, double margin) {
    if (a.bottom >= b.top || b.bottom >= a.top) return false;
    return std::max(gapAlongSidesOf(a, b), gapAlongSidesOf(b, a)) < margin;
}

Site::Taken Site::circled(const Room& room) {
    Eigen::AlignedBox2d bounds;
    double largest = 0.0;
    for (const Footprint& f : room) {
        bounds.extend(f.center);
        largest = std::max(largest, f.half.norm());
    }
    return {room, bounds.center(), 0.5 * bounds.diagonal().norm() + largest};
}

bool Site::isFree(const std::vector<Room>& parts, double margin) const {
    for (const Room& part : parts) {
        const Taken mine = circled(part);
        for (const Taken& other : taken_) {
            if ((other.center - mine.center).norm() > other.radius + mine.radius + margin) continue;
            const std::size_t times = std::max(part.size(), other.room.size());
            for (std::size_t k = 0; k < times; ++k)
                if (meet(part[std::min(k, part.size() - 1)], other.room[std::min(k, other.room.size() - 1)], margin))
                    return false;
        }
    }
    return true;
}

void Site::add(const std::vector<Room>& parts) {
    for (const Room& part : parts) taken_.push_back(circled(part));
}

}  // namespace lidar_obstacles::simulation
