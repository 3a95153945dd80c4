// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Finds the vehicle's own body in its scans: what stays in place while the rest of the world goes by.
#pragma once

#include <cstdint>
#include <vector>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Counts in how many scans each voxel around the vehicle is hit. What the vehicle carries is hit in the same voxels of
/// the vehicle frame again and again, what it passes is not. Memory is constant (some 10 MB).
/// An object is for one thread at a time.
class OwnBodyLearner {
  public:
    OwnBodyLearner();

    /// One scan more. @param returns  those that count (indices into the cloud), e.g. all that are not ground.
    void add(const PointCloud& cloud, const std::vector<std::int32_t>& returns);

    std::size_t scans() const { return scans_; }
    /// True if the vehicle moved enough to tell its body from what stands around it: most of the returns fell into
    /// cells that are not hit again and again. False for fewer than 20 scans.
    bool moved() const;
    /// What stayed in place within 10 m ahead of and behind the origin and 3 m to either side, as boxes with a voxel of
    /// room around them, in descending order of size; empty if nothing did, or if the vehicle has not moved().
    OwnBody learnt() const;

  private:
    /// Cells that are each counted once in a scan.
    struct Counts {
        std::vector<std::uint32_t> last;   ///< scan that counted it last, from 1
        std::vector<std::uint16_t> scans;  ///< that counted it; stays at the largest number it can hold

        void hit(std::size_t cell, std::uint32_t scan);
    };

    std::size_t scans_ = 0;
    Counts voxels_;  ///< and all around those that are hit: a surface at the edge of two flickers between them
    Counts hits_;    ///< the same voxels, hit themselves
    Counts cells_;   ///< coarse, seen from above
};

}  // namespace lidar_obstacles
