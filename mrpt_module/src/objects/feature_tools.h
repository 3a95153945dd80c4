// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "lidar_obstacles/feature_extractor.h"

namespace lidar_obstacles {

/// The smallest rectangle around a group, seen from above.
struct FeatureExtractor::Box {
    Eigen::Vector2f along{1.0f, 0.0f};  ///< its longer side
    Eigen::Vector2f across{0.0f, 1.0f};
    Eigen::AlignedBox2f extent;  ///< in these directions [m]
};

inline constexpr float kFarAway = 10.0f;   // what is farther apart has nothing to do with each other [m]
inline constexpr std::size_t kMost = 256;  // returns that are looked at; of more, every k-th
inline constexpr int kMostColumns = 24;    // likewise
inline constexpr float kBehind = 0.5f;     // a beam that ends so far behind a thing passed it [m]
inline constexpr float kUnknownTop = -1e9f;

inline float& at(FeatureVector& f, Feature k) { return f[static_cast<std::size_t>(k)]; }

inline std::size_t strideFor(std::size_t count) { return 1 + count / kMost; }

inline float share(int part, int of) { return of > 0 ? static_cast<float>(part) / static_cast<float>(of) : 0.0f; }

}  // namespace lidar_obstacles
