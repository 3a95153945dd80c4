// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What needs time: de-skewing, the seam, the 3D filters.
#pragma once

#include "data_sets.h"

namespace lidar_obstacles::bench {

/// Registers `deskew`, `seam` (where the set has point times, or rings to make them of), `spurious` and `static`. Keeps
/// a reference to `set`.
void addMotionStages(const DataSet& set);

}  // namespace lidar_obstacles::bench
