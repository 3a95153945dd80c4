#include "footprint.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr int kHalf = Footprint::kDirections / 2;  // directions and their opposites
constexpr std::size_t kMaxReturns = 300;           // of more, every k-th is looked at

using Extents = Eigen::Array<float, kHalf, 1>;

/// Places along the first half of the directions.
struct Directions {
    Directions() {
        for (int k = 0; k < kHalf; ++k) {
            const float angle = 3.14159265f * static_cast<float>(k) / kHalf;
            cosine[k] = std::cos(angle);
            sine[k] = std::sin(angle);
        }
    }
    Extents operator()(const Eigen::Vector2f& p) const { return cosine * p.x() + sine * p.y(); }

    Extents cosine;
    Extents sine;
};

}  // namespace

Eigen::AlignedBox2f boundsOf(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    Eigen::AlignedBox2f box;
    for (const std::int32_t i : points) box.extend(cloud.xyz[i].head<2>());
    return box;
}

Footprint footprintOf(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    static const Directions kAlong;
    const std::size_t stride = 1 + points.size() / kMaxReturns;
    std::array<Extents, kMaxReturns> along;  // of each return that is looked at
    std::size_t looked_at = 0;
    Footprint f;
    Extents least = Extents::Constant(std::numeric_limits<float>::infinity());
    Extents most = -least;
    for (std::size_t n = 0; n < points.size(); n += stride) {
        const Eigen::Vector2f p = cloud.xyz[points[n]].head<2>();
        along[looked_at] = kAlong(p);
        least = least.min(along[looked_at]);
        most = most.max(along[looked_at]);
        f.box.extend(p);
        ++looked_at;
    }
    const auto set = [&f](int k, float reach, const Eigen::Vector2f& p, std::int32_t i) {
        f.x[k] = p.x();
        f.y[k] = p.y();
        f.reach[k] = reach;
        f.returns[k] = i;
    };
    for (std::size_t n = 0; n < looked_at; ++n) {
        if (((along[n] - least) * (most - along[n])).minCoeff() > 0.0f) continue;  // outermost in no direction
        const std::int32_t i = points[n * stride];
        const Eigen::Vector2f p = cloud.xyz[i].head<2>();
        for (int k = 0; k < kHalf; ++k) {
            if (along[n][k] == most[k]) set(k, most[k], p, i);
            if (along[n][k] == least[k]) set(k + kHalf, -least[k], p, i);
        }
    }
    return f;
}

Footprint merged(const Footprint& a, const Footprint& b) {
    Footprint both = a;
    both.box.extend(b.box);
    for (int k = 0; k < Footprint::kDirections; ++k) {
        if (a.reach[k] >= b.reach[k]) continue;
        both.x[k] = b.x[k];
        both.y[k] = b.y[k];
        both.reach[k] = b.reach[k];
        both.returns[k] = b.returns[k];
    }
    return both;
}

SmallestRectangle smallestRectangle(const Footprint& f) {
    SmallestRectangle best;
    float least_area = std::numeric_limits<float>::infinity();
    for (int k = 0; k < Footprint::kDirections; ++k) {
        const int next = (k + 1) % Footprint::kDirections;
        const Eigen::Vector2f edge(f.x[next] - f.x[k], f.y[next] - f.y[k]);
        const float edge_length = edge.norm();
        if (edge_length == 0.0f) continue;
        const Eigen::Vector2f u = edge / edge_length;
        const Footprint::Numbers along = u.x() * f.x + u.y() * f.y;
        const Footprint::Numbers across = u.x() * f.y - u.y() * f.x;
        const float extent = along.maxCoeff() - along.minCoeff();
        const float depth = across.maxCoeff() - across.minCoeff();
        if (extent * depth >= least_area) continue;
        least_area = extent * depth;
        best.length = std::max(extent, depth);
        best.width = std::min(extent, depth);
        best.along = extent >= depth ? u : Eigen::Vector2f(-u.y(), u.x());
    }
    return best;
}

}  // namespace lidar_obstacles
