// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/seam.h"

#include <algorithm>
#include <cmath>

#include "scan/looked_columns.h"

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
    float begin = 0.0f;  ///< of the first return: turns cut out of a capture begin within a packet [s]
    float turn = 0.0f;   ///< from the first return to the last one [s]
};

/// @param cloud  has returns.
RingLines linesOf(const PointCloud& cloud) {
    RingLines lines;
    lines.rings.resize(static_cast<std::size_t>(cloud.view.rings));
    for (std::size_t i = 0; i < cloud.size(); ++i) lines.rings[cloud.ring[i]].push_back(static_cast<std::int32_t>(i));
    const auto [first, last] = std::minmax_element(cloud.time_offset.begin(), cloud.time_offset.end());
    lines.begin = *first;
    lines.turn = *last - *first;
    const auto earlier = [&](std::int32_t a, std::int32_t b) { return cloud.time_offset[a] < cloud.time_offset[b]; };
    for (auto& line : lines.rings)
        if (!std::is_sorted(line.begin(), line.end(), earlier)) std::stable_sort(line.begin(), line.end(), earlier);
    return lines;
}

double rangeOf(const PointCloud& cloud, std::int32_t i) {
    return (cloud.xyz[i] - cloud.sensor_origin).head<2>().norm();
}

/// When in the turn a return was seen, 0 to 1.
double shareOfTurn(const PointCloud& cloud, const RingLines& lines, std::int32_t i) {
    return (cloud.time_offset[i] - lines.begin) / lines.turn;
}

bool isAtStart(const PointCloud& cloud, const RingLines& lines, std::int32_t i) {
    return shareOfTurn(cloud, lines, i) <= kAtSeam;
}

bool isAtEnd(const PointCloud& cloud, const RingLines& lines, std::int32_t i) {
    return shareOfTurn(cloud, lines, i) >= 1.0 - kAtSeam;
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
        if (!isAtStart(cloud, lines, line.front()) || !isAtEnd(cloud, lines, line.back())) continue;
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

/// True if a higher ring meets, on both sides, what is behind the near side: then the far side is a background.
bool isBackground(const PointCloud& cloud, const std::vector<Pair>& pairs, const std::vector<Pair>& same) {
    const bool upright = cloud.sensor_up.z() >= 0.0f;  // else rings count downwards
    const double far = same.front().near_range + std::abs(same.front().gap);
    return std::any_of(pairs.begin(), pairs.end(), [&](const Pair& p) {
        const bool above = upright ? p.ring > same.back().ring : p.ring < same.front().ring;
        return above && std::abs(p.gap) < kMinGap && std::abs(p.near_range - far) < 0.5;
    });
}

/// The returns along a line from `begin` on until the surface, or half a turn, ends; `longest` at most.
template <class It>
std::vector<std::int32_t> follow(const PointCloud& cloud, It begin, It end, std::size_t longest) {
    std::vector<std::int32_t> run;
    for (It it = begin; it != end && run.size() < longest; ++it) {
        if (it != begin) {
            const float reach = 0.15f + 0.02f * static_cast<float>(rangeOf(cloud, *it));
            if ((cloud.xyz[*it] - cloud.xyz[*(it - 1)]).norm() > reach) break;
        }
        run.push_back(*it);
    }
    return run;
}

/// One side of the seam: where the gap was seen, and the returns there.
struct Side {
    std::vector<double> ranges;  ///< of the rings that show the gap [m]
    std::vector<std::int32_t> returns;
    std::size_t longest = 0;  ///< run of those rings
    std::size_t showing = 0;  ///< returns of those rings
};

struct Sides {
    std::vector<Pair> pairs;  ///< the rings that show the gap
    Side early, late;
};

/// Adds a ring that meets the surface, as far along as the rings that show the gap go: it may be the ground before it.
void addRun(std::vector<std::int32_t> run, bool shows, Side& side) {
    if (shows) {
        side.longest = std::max(side.longest, run.size());
        side.showing += run.size();
    }
    side.returns.insert(side.returns.end(), run.begin(), run.end());
}

/// Follows the surface away from the seam on both sides: on rings that show the gap, or on the others, which may pass
/// above or below one of the two parts.
void addRings(const PointCloud& cloud, const RingLines& lines, bool showing, Sides& sides) {
    constexpr std::size_t kAny = 1U << 30U;
    Side &early = sides.early, &late = sides.late;
    for (int ring = 0; ring < static_cast<int>(lines.rings.size()); ++ring) {
        const auto& line = lines.rings[static_cast<std::size_t>(ring)];
        const bool shows =
            std::any_of(sides.pairs.begin(), sides.pairs.end(), [&](const Pair& p) { return p.ring == ring; });
        if (line.empty() || shows != showing) continue;
        const auto half = std::partition_point(line.begin(), line.end(),
                                               [&](std::int32_t i) { return shareOfTurn(cloud, lines, i) < 0.5; });
        if (isAtStart(cloud, lines, line.front()) && isOneOf(early.ranges, rangeOf(cloud, line.front())))
            addRun(follow(cloud, line.begin(), half, shows ? kAny : early.longest), shows, early);
        if (isAtEnd(cloud, lines, line.back()) && isOneOf(late.ranges, rangeOf(cloud, line.back())))
            addRun(follow(cloud, line.rbegin(), std::make_reverse_iterator(half), shows ? kAny : late.longest), shows,
                   late);
    }
}

/// Are the first and the last column of a ring neighbours, but for what a turn that ends with a whole packet leaves out
/// or has twice? Those of a sensor that looks ahead only are not.
bool closes(const OrganizedView& view, const std::vector<std::int32_t>& line) {
    const int apart = view.wrap(view.column_of[line.front()] - view.column_of[line.back()]);
    return std::min(apart, view.columns - apart) <= kColumnsOfPacket + 2.0 * kAtSeam * view.columns;
}

}  // namespace

SeamGap findSeamGap(const PointCloud& cloud) {
    SeamGap seam;
    if (cloud.view.empty() || cloud.time_offset.empty()) return seam;
    const RingLines lines = linesOf(cloud);
    if (!(lines.turn > 0.0f)) return seam;  // all at one time
    const std::vector<Pair> pairs = pairsOf(cloud, lines);
    std::vector<Pair> best;
    for (const Pair& p : pairs) {
        if (std::abs(p.gap) < kMinGap || std::abs(p.gap) > kMaxGap) continue;
        std::vector<Pair> same = alike(pairs, p);
        if (same.size() > best.size()) best = std::move(same);
    }
    if (best.size() < kMinRings || isBackground(cloud, pairs, best)) return seam;
    if (!closes(cloud.view, lines.rings[static_cast<std::size_t>(best.front().ring)])) return seam;
    seam.rings = static_cast<int>(best.size());
    Sides sides{best, {}, {}};
    Side &early = sides.early, &late = sides.late;
    for (const Pair& p : best) {
        seam.gap += p.gap / seam.rings;
        early.ranges.push_back(p.gap > 0.0 ? p.near_range : p.near_range - p.gap);
        late.ranges.push_back(early.ranges.back() + p.gap);
    }
    for (const bool showing : {true, false}) addRings(cloud, lines, showing, sides);
    seam.early_share = static_cast<double>(early.showing) / static_cast<double>(early.showing + late.showing);
    seam.early = std::move(early.returns);
    seam.late = std::move(late.returns);
    return seam;
}

namespace {

/// Along which the parts are apart: traffic ahead and behind moves along the vehicle's axis, anything else is only
/// known to have moved along the line of sight.
Eigen::Vector3f directionOf(const PointCloud& cloud, const SeamGap& seam) {
    constexpr float kAhead = 0.94f;  // cosine of 20 deg
    const Eigen::Vector3f at =
        0.5f * (cloud.xyz[seam.early.front()] + cloud.xyz[seam.late.front()]) - cloud.sensor_origin;
    Eigen::Vector3f sight = Eigen::Vector3f(at.x(), at.y(), 0.0f).normalized();
    if (std::abs(sight.x()) < kAhead) return sight;
    return {sight.x() > 0.0f ? 1.0f : -1.0f, 0.0f, 0.0f};
}

}  // namespace

PointCloud mendSeam(PointCloud cloud, const SeamGap& seam) {
    if (seam.rings == 0) return cloud;
    const Eigen::Vector3f sight = directionOf(cloud, seam);
    const auto forward = static_cast<float>(seam.gap * (1.0 - seam.early_share));
    const auto back = static_cast<float>(seam.gap * seam.early_share);
    for (const std::int32_t i : seam.early) cloud.xyz[i] += forward * sight;
    for (const std::int32_t i : seam.late) cloud.xyz[i] -= back * sight;
    return cloud;
}

}  // namespace lidar_obstacles
