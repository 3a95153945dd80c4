#include "footprint.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr int kDirections = 8;            // and their opposites
constexpr std::size_t kMaxReturns = 300;  // of more, every k-th is looked at

std::array<Eigen::Vector2f, kDirections> directions() {
    std::array<Eigen::Vector2f, kDirections> d;
    for (int k = 0; k < kDirections; ++k) {
        const float angle = 3.14159265f * static_cast<float>(k) / kDirections;
        d[k] = {std::cos(angle), std::sin(angle)};
    }
    return d;
}

}  // namespace

Eigen::AlignedBox2f boundsOf(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    Eigen::AlignedBox2f box;
    for (const std::int32_t i : points) box.extend(cloud.xyz[i].head<2>());
    return box;
}

Footprint footprintOf(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    static const std::array<Eigen::Vector2f, kDirections> kDirection = directions();
    std::array<float, kDirections> least;
    std::array<float, kDirections> most;
    std::array<std::int32_t, kDirections> least_at{};
    std::array<std::int32_t, kDirections> most_at{};
    least.fill(1e9f);
    most.fill(-1e9f);
    Footprint f;
    const std::size_t stride = 1 + points.size() / kMaxReturns;
    for (std::size_t n = 0; n < points.size(); n += stride) {
        const std::int32_t i = points[n];
        const Eigen::Vector2f p = cloud.xyz[i].head<2>();
        f.box.extend(p);
        for (int k = 0; k < kDirections; ++k) {
            const float s = kDirection[k].dot(p);
            least_at[k] = s < least[k] ? i : least_at[k];
            least[k] = std::min(least[k], s);
            most_at[k] = s > most[k] ? i : most_at[k];
            most[k] = std::max(most[k], s);
        }
    }
    if (points.empty()) return f;
    std::array<std::int32_t, 2 * kDirections> outermost;
    std::copy(most_at.begin(), most_at.end(), std::copy(least_at.begin(), least_at.end(), outermost.begin()));
    std::sort(outermost.begin(), outermost.end());
    f.returns.assign(outermost.begin(), std::unique(outermost.begin(), outermost.end()));
    for (const std::int32_t i : f.returns) f.outline.emplace_back(cloud.xyz[i].x(), cloud.xyz[i].y());
    return f;
}

Footprint merged(const Footprint& a, const Footprint& b) {
    Footprint both = a;
    both.box.extend(b.box);
    both.outline.insert(both.outline.end(), b.outline.begin(), b.outline.end());
    both.returns.insert(both.returns.end(), b.returns.begin(), b.returns.end());
    return both;
}

}  // namespace lidar_obstacles
