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

/// Takes what hangs above `gates.max_bottom` out of pieces that seen from above hold what stands below it as well: a
/// car under a crown, a person under a sign. Beams passed below what hangs, as for withoutOverhangs(), but those pass
/// through the windows of a car, too: a piece is parted only where the recognizer finds more returns in a whole object
/// without its upper part than with it, and where the rest is no larger than the longest vehicle.
class HangingParts {
  public:
    /// @param featuresOf  of the same scan as `scan`. All must outlive this.
    HangingParts(const SurfaceTops& scan, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                 const GateParams& params)
        : scan_(scan), featuresOf_(featuresOf), recognizer_(recognizer), params_(params) {}

    /// @param rejected  gets what hangs, as Floating.
    void takeOut(std::vector<Cluster>& pieces, std::vector<RejectedCluster>& rejected);

  private:
    struct Candidate {
        Cluster* piece;
        std::vector<std::int32_t> upper, rest;
        std::array<FeatureVector, 2> features;  ///< of the piece, and of it without its upper part
    };
    FeatureVector measured(const std::vector<std::int32_t>& points);
    std::vector<Candidate> candidatesOf(std::vector<Cluster>& pieces);

    const SurfaceTops& scan_;
    FeatureExtractor& featuresOf_;
    const Recognizer& recognizer_;
    const GateParams& params_;
};

}  // namespace lidar_obstacles
