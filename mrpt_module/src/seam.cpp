#include "lidar_obstacles/seam.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr double kMaxGap = 3.5;   // 35 m/s over a tenth of a second [m]
constexpr double kMinGap = 0.12;  // less is noise, or does not matter [m]
constexpr double kAtSeam =
    0.003;  // a surface at the seam is hit this soon after the start and before the end, in turns
constexpr int kMinRings = 2;

/// Returns of each ring in the order of time, with their range seen from above.
struct RingLines {
    std::vector<std::vector<std::int32_t>> rings;
    float turn = 0.0f;  ///< how long the scan took [s]
};

RingLines linesOf(const PointCloud& cloud) {
    RingLines lines;
    lines.rings.resize(static_cast<std::size_t>(cloud.view.rings));
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        lines.rings[cloud.ring[i]].push_back(static_cast<std::int32_t>(i));
        lines.turn = std::max(lines.turn, cloud.time_offset[i]);
    }
    const auto earlier = [&](std::int32_t a, std::int32_t b) { return cloud.time_offset[a] < cloud.time_offset[b]; };
    for (auto& line : lines.rings)
        if (!std::is_sorted(line.begin(), line.end(), earlier)) std::stable_sort(line.begin(), line.end(), earlier);
    return lines;
}

double rangeOf(const PointCloud& cloud, std::int32_t i) {
    return (cloud.xyz[i] - cloud.sensor_origin).head<2>().norm();
}

bool isAtStart(const PointCloud& cloud, std::int32_t i, float turn) { return cloud.time_offset[i] <= kAtSeam * turn; }
bool isAtEnd(const PointCloud& cloud, std::int32_t i, float turn) {
    return cloud.time_offset[i] >= (1.0f - kAtSeam) * turn;
}

bool isOneOf(const std::vector<double>& ranges, double range) {
    constexpr double kNear = 0.3;  // [m]
    return std::any_of(ranges.begin(), ranges.end(), [=](double r) { return std::abs(r - range) < kNear; });
}

/// Both sides of the seam on one ring, and how far apart.
struct Pair {
    int ring = 0;
    double near_range = 0.0;  ///< of the nearer side [m]
    double gap = 0.0;         ///< late minus early [m]
};

std::vector<Pair> pairsOf(const PointCloud& cloud, const RingLines& lines) {
    std::vector<Pair> pairs;
    for (std::size_t ring = 0; ring < lines.rings.size(); ++ring) {
        const auto& line = lines.rings[ring];
        if (line.size() < 2) continue;
        if (!isAtStart(cloud, line.front(), lines.turn) || !isAtEnd(cloud, line.back(), lines.turn)) continue;
        const double early = rangeOf(cloud, line.front()), late = rangeOf(cloud, line.back());
        pairs.push_back({static_cast<int>(ring), std::min(early, late), late - early});
    }
    return pairs;
}

/// The pairs that show the gap of `first` at its range.
std::vector<Pair> alike(const std::vector<Pair>& pairs, const Pair& first) {
    constexpr double kSame = 0.12, kUpright = 0.6;  // [m]
    std::vector<Pair> same;
    for (const Pair& p : pairs)
        if (std::abs(p.gap - first.gap) < kSame && std::abs(p.near_range - first.near_range) < kUpright)
            same.push_back(p);
    return same;
}

/// True if another ring meets, on both sides, what is behind the near side: then the far side is a background.
bool isBackground(const std::vector<Pair>& pairs, const std::vector<Pair>& same) {
    const double far = same.front().near_range + std::abs(same.front().gap);
    return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& p) {
        return p.ring > same.back().ring && std::abs(p.gap) < kMinGap && std::abs(p.near_range - far) < 0.5;
    });
}

/// The returns along a line from `begin` on, until the surface ends.
template <class It>
void follow(const PointCloud& cloud, It begin, It end, std::vector<std::int32_t>& run) {
    for (It it = begin; it != end; ++it) {
        if (it != begin) {
            const float reach = 0.15f + 0.02f * static_cast<float>(rangeOf(cloud, *it));
            if ((cloud.xyz[*it] - cloud.xyz[*(it - 1)]).norm() > reach) return;
        }
        run.push_back(*it);
    }
}

}  // namespace

SeamGap findSeamGap(const PointCloud& cloud) {
    SeamGap seam;
    if (cloud.view.empty() || cloud.time_offset.empty()) return seam;
    const RingLines lines = linesOf(cloud);
    const std::vector<Pair> pairs = pairsOf(cloud, lines);
    std::vector<Pair> best;
    for (const Pair& p : pairs) {
        if (std::abs(p.gap) < kMinGap || std::abs(p.gap) > kMaxGap) continue;
        std::vector<Pair> same = alike(pairs, p);
        if (same.size() > best.size()) best = std::move(same);
    }
    if (best.size() < kMinRings || isBackground(pairs, best)) return seam;
    seam.rings = static_cast<int>(best.size());
    std::vector<double> early_ranges, late_ranges;
    for (const Pair& p : best) {
        seam.gap += p.gap / seam.rings;
        early_ranges.push_back(p.gap > 0.0 ? p.near_range : p.near_range - p.gap);
        late_ranges.push_back(early_ranges.back() + p.gap);
    }
    // also rings that hit the surface on one side only: above it or below it they pass the other part
    for (const auto& line : lines.rings) {
        if (line.empty()) continue;
        const auto half = line.begin() + static_cast<std::ptrdiff_t>(line.size() / 2);
        if (isAtStart(cloud, line.front(), lines.turn) && isOneOf(early_ranges, rangeOf(cloud, line.front())))
            follow(cloud, line.begin(), half, seam.early);
        if (isAtEnd(cloud, line.back(), lines.turn) && isOneOf(late_ranges, rangeOf(cloud, line.back())))
            follow(cloud, line.rbegin(), std::make_reverse_iterator(half), seam.late);
    }
    return seam;
}

namespace {

/// Along which the parts are apart: traffic ahead and behind moves along the vehicle's axis, anything else is only
/// known to have moved along the line of sight.
Eigen::Vector3f directionOf(const PointCloud& cloud, const SeamGap& seam) {
    constexpr float kAhead = 0.94f;  // cosine of 20 deg
    const Eigen::Vector3f at =
        0.5f * (cloud.xyz[seam.early.front()] + cloud.xyz[seam.late.front()]) - cloud.sensor_origin;
    const Eigen::Vector3f sight = Eigen::Vector3f(at.x(), at.y(), 0.0f).normalized();
    if (std::abs(sight.x()) < kAhead) return sight;
    return {sight.x() > 0.0f ? 1.0f : -1.0f, 0.0f, 0.0f};
}

}  // namespace

PointCloud mendSeam(PointCloud cloud, const SeamGap& seam) {
    if (seam.rings == 0) return cloud;
    const Eigen::Vector3f sight = directionOf(cloud, seam);
    const auto all = static_cast<double>(seam.early.size() + seam.late.size());
    const auto forward = static_cast<float>(seam.gap * static_cast<double>(seam.late.size()) / all);
    const auto back = static_cast<float>(seam.gap * static_cast<double>(seam.early.size()) / all);
    for (const std::int32_t i : seam.early) cloud.xyz[i] += forward * sight;
    for (const std::int32_t i : seam.late) cloud.xyz[i] -= back * sight;
    return cloud;
}

}  // namespace lidar_obstacles
