// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Pages that play a changed recording twice: as the baseline saw it, and as it is seen now.
#pragma once

#include "drift.h"
#include "manifest.h"
#include "merge.h"

namespace lidar_obstacles::fleet {

/// Has obstacle-replay write the pages of the recordings that changed most (`options.replays`) into replays/ of
/// `options.into`, and sets Change::replay or Change::no_replay of each. Of long recordings the scans about the one
/// that changed most are played.
void makeReplays(const MergeOptions& options, const Settings& now, Drift& drift);

}  // namespace lidar_obstacles::fleet
