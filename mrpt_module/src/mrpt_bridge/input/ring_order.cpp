// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/ring_order.h"
#include "scan/median.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lidar_obstacles {
namespace {

/// Where the returns of a ring lie: sines of elevations.
struct Level {
    int ring = 0;
    float middle = 0.0f;  ///< median
    float spread = 0.0f;  ///< median distance from it
};

/// Of the rings that have returns enough, in the order of their numbers.
std::vector<Level> levelsOf(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint16_t>& ring,
                            int rings) {
    constexpr std::size_t kEvery = 7;  // shares no factor with a usual number of rings, that may come in turn
    constexpr std::size_t kFewest = 5;
    std::vector<std::vector<float>> sines(static_cast<std::size_t>(rings));
    for (std::size_t i = 0; i < points.size(); i += kEvery) sines[ring[i]].push_back(points[i].z() / points[i].norm());
    std::vector<Level> levels;
    levels.reserve(sines.size());
    for (std::size_t r = 0; r < sines.size(); ++r) {
        if (sines[r].size() < kFewest) continue;
        Level level{static_cast<int>(r), medianOf(sines[r]), 0.0f};
        for (float& s : sines[r]) s = std::abs(s - level.middle);
        level.spread = medianOf(sines[r]);
        levels.push_back(level);
    }
    return levels;
}

/// Share of the pairs in which the higher number is the higher ring.
double shareOfRising(const std::vector<Level>& levels) {
    std::size_t rising = 0;
    for (std::size_t a = 0; a < levels.size(); ++a)
        for (std::size_t b = a + 1; b < levels.size(); ++b) rising += levels[b].middle > levels[a].middle;
    return 2.0 * static_cast<double>(rising) / static_cast<double>(levels.size() * (levels.size() - 1));
}

/// True if nearly all rings lie apart. @param levels  rising
bool areApart(const std::vector<Level>& levels) {
    std::size_t apart = 0;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const float below = k > 0 ? levels[k].middle - levels[k - 1].middle : 1.0f;
        const float above = k + 1 < levels.size() ? levels[k + 1].middle - levels[k].middle : 1.0f;
        apart += levels[k].spread < 0.5f * std::min(below, above);
    }
    return 10 * apart >= 9 * levels.size();
}

}  // namespace

std::vector<int> ringsUpwards(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint16_t>& ring,
                              int rings) {
    constexpr double kNearlyAll = 0.9;
    std::vector<Level> levels = levelsOf(points, ring, rings);
    if (levels.size() < 2) return {};
    const double rising = shareOfRising(levels);
    if (rising >= kNearlyAll) return {};
    std::vector<int> number(static_cast<std::size_t>(rings), -1);
    if (rising <= 1.0 - kNearlyAll) {
        std::iota(number.rbegin(), number.rend(), 0);
        return number;
    }
    std::sort(levels.begin(), levels.end(), [](const Level& a, const Level& b) { return a.middle < b.middle; });
    if (!areApart(levels)) return {};
    int next = 0;
    for (const Level& level : levels) number[static_cast<std::size_t>(level.ring)] = next++;
    for (int& n : number)
        if (n < 0) n = next++;
    return number;
}

}  // namespace lidar_obstacles
