// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One scan as the replay page holds it: quantised, ordered by what matters, packed into a line of text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "exports/scan_output.h"

namespace lidar_obstacles::apps {

/// Size of the steps in which coordinates of returns are told [m].
constexpr double kPageStep = 0.02;

/// A return of a page: vehicle frame, in steps of kPageStep.
struct PagePoint {
    std::int16_t x = 0, y = 0, z = 0;
    ReturnKind kind = ReturnKind::None;
    std::uint32_t rank = 0;  ///< returns of small rank stay when there is room for few only
};

/// A scan, ready to be packed with more or fewer returns.
struct PageScan {
    std::vector<PagePoint> points;  ///< ring by ring along the turn, where the source has rings
    std::string structure;          ///< JSON: rows (pageRow) of the obstacles of class structure
    std::string grid;               ///< the occupancy grid in runs of equal cells
    std::string row;                ///< JSON: number, time, pose, returns and the other obstacles of the scan
};

/// What a page keeps of a scan: at most `max_points` of its returns; those farther than 650 m are left out.
/// Ranks: returns of road users first, the others so that near and far are thinned to the same density.
PageScan pageScan(const ScanOutput& scan, std::size_t max_points);

/// The scan with its `max_points` first returns by rank: zlib-compressed, then base64. What is in it, in this order:
/// u32 and bytes of `structure`, u32 and bytes of `grid`, u32 number of returns, and of these one byte each of: kind,
/// low bytes of x differences, high bytes, the same of y and z. A difference is to the return before.
std::string packed(const PageScan& scan, std::size_t max_points);

/// Bytes as zlib packs them, in base64. @throws std::bad_alloc
std::string deflated(const std::string& bytes);

/// The scan as bytes for a temporary file, and back.
std::string toBytes(const PageScan& scan);
PageScan pageScanOf(const std::string& bytes);

}  // namespace lidar_obstacles::apps
