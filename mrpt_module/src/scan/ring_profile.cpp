// SPDX-License-Identifier: BSD-3-Clause
#include "scan/ring_profile.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lidar_obstacles {
namespace {

/// Distance of p to the line from a to b, positive where the sensor is on the other side [m]; 0 if they are one place.
float distanceBehind(const ProfilePoint& p, const ProfilePoint& a, const ProfilePoint& b) {
    const float ax = 1.0f / a.v, ay = a.u / a.v;
    const float dx = 1.0f / b.v - ax, dy = b.u / b.v - ay;
    const float length = std::hypot(dx, dy);
    return length > 1e-3f ? ((1.0f / p.v - ax) * dy - (p.u / p.v - ay) * dx) / length : 0.0f;
}

/// Those that no line between others passes before, by azimuth: an upper convex hull.
std::vector<std::size_t> nearestOnes(const std::vector<ProfilePoint>& profile, const std::vector<std::size_t>& order) {
    std::vector<std::size_t> hull;
    for (const std::size_t k : order) {
        const ProfilePoint& c = profile[k];
        const auto isBehind = [&](std::size_t i, std::size_t j) {  // j is behind the line from i to k
            const ProfilePoint &a = profile[i], &b = profile[j];
            return (b.u - a.u) * (c.v - a.v) >= (c.u - a.u) * (b.v - a.v);
        };
        while (hull.size() > 1 && isBehind(hull[hull.size() - 2], hull.back())) hull.pop_back();
        hull.push_back(k);
    }
    return hull;
}

}  // namespace

std::optional<ProfilePoint> profilePointOf(const Eigen::Vector2f& p, const Eigen::Vector2f& ahead) {
    constexpr float kLeastAhead = 0.3f;  // of the range
    const float range = p.norm(), x = p.dot(ahead), y = ahead.x() * p.y() - ahead.y() * p.x();
    if (!(x > kLeastAhead * range)) return std::nullopt;
    return ProfilePoint{range, y / x, 1.0f / x};
}

std::vector<float> depthsOf(const std::vector<ProfilePoint>& profile) {
    std::vector<std::size_t> order(profile.size());
    std::iota(order.begin(), order.end(), 0);
    const auto before = [&](std::size_t a, std::size_t b) {
        return profile[a].u != profile[b].u ? profile[a].u < profile[b].u : a < b;
    };
    if (profile.size() > 1 && profile.back().u < profile.front().u) std::reverse(order.begin(), order.end());
    if (!std::is_sorted(order.begin(), order.end(), before)) std::sort(order.begin(), order.end(), before);
    const std::vector<std::size_t> hull = nearestOnes(profile, order);
    std::vector<float> depth(profile.size(), 0.0f);
    std::size_t side = 0;
    for (const std::size_t k : order) {
        const ProfilePoint& p = profile[k];
        while (side + 2 < hull.size() && profile[hull[side + 1]].u < p.u) ++side;
        if (side + 1 >= hull.size()) break;
        const ProfilePoint &a = profile[hull[side]], &b = profile[hull[side + 1]];
        depth[k] = std::max(0.0f, distanceBehind(p, a, b));
    }
    return depth;
}

float notchBetween(const std::vector<ProfilePoint>& profile, const std::vector<float>& depth, std::size_t k) {
    const float jump = profile[k].range - profile[k - 1].range;
    if (std::abs(jump) <= kNotchDepth) return 0.0f;
    return depth[jump > 0.0f ? k : k - 1];
}

}  // namespace lidar_obstacles
