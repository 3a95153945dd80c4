// SPDX-License-Identifier: BSD-3-Clause
#include "objects/footprint.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr int kHalf = Footprint::kDirections / 2;  // directions and their opposites
constexpr int kAcross = kHalf / 2;                 // that of +y
constexpr std::size_t kMaxReturns = 300;           // of more, every k-th is looked at

using Extents = Eigen::Array<float, kHalf, 1>;

/// Places along the first half of the directions.
struct Directions {
    Directions() {
        for (int k = 0; k < kHalf; ++k) {
            const float angle = static_cast<float>(M_PI) * static_cast<float>(k) / kHalf;
            cosine[k] = k == kAcross ? 0.0f : std::cos(angle);
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
    return footprintOf(points.data(), points.size(), cloud);
}

Footprint footprintOf(const std::int32_t* points, std::size_t count, const PointCloud& cloud) {
    static const Directions kAlong;
    const std::size_t stride = 1 + count / kMaxReturns;
    std::array<Extents, kMaxReturns> along;  // of each return that is looked at
    std::size_t looked_at = 0;
    Footprint f;
    Extents least = Extents::Constant(std::numeric_limits<float>::infinity());
    Extents most = -least;
    for (std::size_t n = 0; n < count; n += stride) {
        const Eigen::Vector2f p = cloud.xyz[points[n]].head<2>();
        along[looked_at] = kAlong(p);
        least = least.min(along[looked_at]);
        most = most.max(along[looked_at]);
        ++looked_at;
    }
    if (looked_at == 0) return f;
    f.box = Eigen::AlignedBox2f(Eigen::Vector2f(least[0], least[kAcross]), Eigen::Vector2f(most[0], most[kAcross]));
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

namespace {

/// The corners of an outline, each once; the first one again in the places that are left.
struct Corners {
    explicit Corners(const Footprint& f)
        : x(Footprint::Numbers::Constant(f.x[0])), y(Footprint::Numbers::Constant(f.y[0])) {
        for (int k = 1; k < Footprint::kDirections; ++k) {
            x[count] = f.x[k];  // written over by the next one if it is the one before again
            y[count] = f.y[k];
            count += static_cast<int>(f.returns[k] != f.returns[k - 1]);
        }
        if (count == Footprint::kDirections) return;
        x[count] = f.x[0];
        y[count] = f.y[0];
    }

    Footprint::Numbers x;
    Footprint::Numbers y;
    int count = 1;
};

/// The edge whose rectangle is the smallest, and of those that are as small the longest: the three rectangles of a
/// triangle are all of one area. @return -1 if no edge has a length.
template <int kMost>
int smallestOf(const Eigen::Array<float, kMost, 1>& area, const Eigen::Array<float, kMost, 1>& longer,
               const Eigen::Array<float, kMost, 1>& edge) {
    constexpr float kRounding = 1e-4f;  // share
    constexpr float kLine = 1e-5f;      // what lies on a line covers no more, by rounding [m^2]
    float least = std::numeric_limits<float>::infinity();
    for (int k = 0; k < kMost; ++k)
        if (edge[k] > 0.0f) least = std::min(least, area[k]);
    const float most = least * (1.0f + kRounding) + kLine;
    int best = -1;
    for (int k = 0; k < kMost; ++k)
        if (edge[k] > 0.0f && area[k] <= most && (best < 0 || longer[k] > longer[best] * (1.0f + kRounding))) best = k;
    return best;
}

/// The first kMost corners tell the rectangle.
template <int kMost>
SmallestRectangle smallestAround(const Corners& corners) {
    using Numbers = Eigen::Array<float, kMost, 1>;  // of each edge, from one corner to the next
    // from the first corner: far away, a float has no digits to spare
    const Numbers x = corners.x.head<kMost>() - corners.x[0];
    const Numbers y = corners.y.head<kMost>() - corners.y[0];
    Numbers u_x;
    Numbers u_y;
    u_x << x.template tail<kMost - 1>() - x.template head<kMost - 1>(), x[0] - x[kMost - 1];
    u_y << y.template tail<kMost - 1>() - y.template head<kMost - 1>(), y[0] - y[kMost - 1];
    Numbers length = u_x.square() + u_y.square();
    // one by one: Eigen's root of several at once is an estimate, and another one on another processor
    for (float& edge : length) edge = std::sqrt(edge);
    u_x /= length.max(std::numeric_limits<float>::min());
    u_y /= length.max(std::numeric_limits<float>::min());
    Numbers first = Numbers::Constant(std::numeric_limits<float>::infinity());  // along the edge
    Numbers last = -first;
    Numbers lowest = first;  // across it
    Numbers highest = last;
    for (int k = 0; k < corners.count; ++k) {
        const Numbers along = u_x * x[k] + u_y * y[k];
        const Numbers across = u_x * y[k] - u_y * x[k];
        first = first.min(along);
        last = last.max(along);
        lowest = lowest.min(across);
        highest = highest.max(across);
    }
    const Numbers extent = last - first;
    const Numbers depth = highest - lowest;
    const int best = smallestOf<kMost>(extent * depth, extent.max(depth), length);
    if (best < 0) return {};
    const bool lengthwise = extent[best] >= depth[best];
    return {std::max(extent[best], depth[best]), std::min(extent[best], depth[best]),
            lengthwise ? Eigen::Vector2f(u_x[best], u_y[best]) : Eigen::Vector2f(-u_y[best], u_x[best])};
}

}  // namespace

SmallestRectangle smallestRectangle(const Footprint& f) {
    const Corners corners(f);
    if (corners.count <= 8) return smallestAround<8>(corners);  // as a rule
    if (corners.count <= 12) return smallestAround<12>(corners);
    return smallestAround<Footprint::kDirections>(corners);
}

}  // namespace lidar_obstacles
