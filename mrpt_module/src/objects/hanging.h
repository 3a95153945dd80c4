// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/feature_extractor.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/recognizer.h"
#include "objects/follow_up.h"

namespace lidar_obstacles {

/// Which returns hang: those below which a beam passed, and what goes on from them upwards and to the sides.
class HangingReturns {
  public:
    /// Did beams pass below some of what hangs together, or in most of its columns? A single one may have passed
    /// beside.
    enum class Proof { Some, Most };

    /// @param returns  that are looked at: of them those higher than `above` the ground [m]. None hang without a view.
    HangingReturns(const SurfaceTops& scan, const std::vector<std::int32_t>& returns, double above);

    /// Those of some returns that hang, and the others; both in their order.
    std::array<std::vector<std::int32_t>, 2> partsOf(const std::vector<std::int32_t>& points, Proof proof) const;

  private:
    static constexpr std::int32_t kOther = -2, kUpper = -1;

    /// What hangs together with a return, from it on; numbers it.
    std::vector<std::int32_t> grow(const PointCloud& cloud, std::int32_t first);

    std::vector<std::int32_t> part_;  ///< of each return of the cloud: the number of what it hangs with
    std::vector<bool> mostly_;        ///< of each part: beams passed below it in most of its columns
};

/// Parts clusters of which an upper part of at least `gates.min_points` returns hangs above `gates.max_bottom`, with
/// beams below most of it: it becomes a cluster of its own, behind all others.
void partAtHanging(std::vector<Cluster>& clusters, const HangingReturns& hanging, const GroundModel& ground,
                   const GateParams& params);

/// Takes what hangs above `gates.max_bottom` out of pieces that seen from above hold what stands below it as well: a
/// car under a crown, a person under a sign. Beams passed below what hangs, as for markHanging(), but those pass
/// through the windows of a car, too: a piece is parted only where the recognizer finds more returns in whole objects
/// without its upper part than with it, and where the rest is no larger than the longest vehicle. Over a whole road
/// user, what hangs counts as an object of its own.
class HangingParts {
  public:
    /// @param featuresOf  of the same scan as `scan`. All must outlive this.
    HangingParts(const SurfaceTops& scan, const HangingReturns& hanging, FeatureExtractor& featuresOf,
                 const Recognizer& recognizer, const GateParams& params)
        : scan_(scan), hanging_(hanging), featuresOf_(featuresOf), recognizer_(recognizer), params_(params) {}

    /// @param rejected  gets what hangs, as Floating.
    void takeOut(std::vector<Cluster>& pieces, std::vector<RejectedCluster>& rejected);

  private:
    struct Candidate {
        Cluster* piece;
        std::vector<std::int32_t> upper, rest;
        std::array<FeatureVector, 3> features;  ///< of the piece, of the rest, of its upper part
    };
    FeatureVector measured(const std::vector<std::int32_t>& points);
    std::vector<Candidate> candidatesOf(std::vector<Cluster>& pieces);

    const SurfaceTops& scan_;
    const HangingReturns& hanging_;
    FeatureExtractor& featuresOf_;
    const Recognizer& recognizer_;
    const GateParams& params_;
};

}  // namespace lidar_obstacles
