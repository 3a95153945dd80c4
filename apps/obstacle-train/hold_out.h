// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which scenes are kept back: the trees do not learn from them, so they can calibrate the probabilities and judge.
#pragma once

#include <algorithm>
#include <cstddef>

#include "lidar_obstacles/simulation/random_scene.h"

namespace lidar_obstacles::apps {

/// Scenes of a set: one of each kind.
inline std::size_t scenesOfSet() { return simulation::randomScenes().size(); }

/// The fewest scenes that can be trained on: a set to learn from, and one that is kept back.
inline int leastScenes() { return static_cast<int>(2 * scenesOfSet()); }

/// True if scene k of so many is kept back: every fifth set is; where there are fewer than five whole ones, the last.
/// @param scenes  leastScenes() or more.
inline bool isKeptBack(std::size_t k, std::size_t scenes) {
    const std::size_t every = std::min<std::size_t>(5, scenes / scenesOfSet());
    return k / scenesOfSet() % every == every - 1;
}

}  // namespace lidar_obstacles::apps
