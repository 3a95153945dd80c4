// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which scans to look at first.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/evaluate.h"

namespace lidar_obstacles::evaluation {

/// A scan in which something went wrong.
struct WorstScan {
    std::size_t set = 0;  ///< index of the result it is from
    int scan_index = 0;
    double timestamp = 0.0;
    double badness = 0.0;                 ///< sum over its objects, see worstScans()
    const ObjectRecord* worst = nullptr;  ///< the object that failed most; lives in the result
    std::vector<std::string> reasons;     ///< one line per object that failed, the worst first
};

/// The `count` worst scans, the worst first. An object that was asked for and not found counts 1; a found one the
/// larger of |nearest face error| / 2 m and |heading error modulo 180| / 45 degrees, at most 0.9. In a set with a
/// target only the target counts. Scans less than 2 s from one already chosen, with the same object in the lead, come
/// only where there are not enough others: ten pictures of one event tell less.
std::vector<WorstScan> worstScans(const std::vector<SetResult>& sets, std::size_t count);

}  // namespace lidar_obstacles::evaluation
