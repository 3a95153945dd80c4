#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "lidar_obstacles/features.h"

namespace lidar_obstacles {

inline constexpr float kFarAway = 10.0f;   // what is farther apart has nothing to do with each other [m]
inline constexpr std::size_t kMost = 256;  // returns that are looked at; of more, every k-th
inline constexpr int kMostColumns = 24;    // likewise
inline constexpr float kBehind = 0.5f;     // a beam that ends so far behind a thing passed it [m]
inline constexpr float kUnknownTop = -1e9f;

inline float& at(FeatureVector& f, Feature k) { return f[static_cast<std::size_t>(k)]; }

inline std::size_t strideFor(std::size_t count) { return 1 + count / kMost; }

/// The k-th of n (0 .. 1) of some numbers; `otherwise` where there is none. Reorders them.
inline float quantile(std::vector<float>& numbers, float k, float otherwise) {
    if (numbers.empty()) return otherwise;
    const auto place = numbers.begin() + static_cast<std::ptrdiff_t>(k * static_cast<float>(numbers.size() - 1));
    std::nth_element(numbers.begin(), place, numbers.end());
    return *place;
}

inline float share(int part, int of) { return of > 0 ? static_cast<float>(part) / static_cast<float>(of) : 0.0f; }

}  // namespace lidar_obstacles
