// SPDX-License-Identifier: BSD-3-Clause
// The features that tell two things beside each other from one: a body bulges outwards.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lidar_obstacles/feature_extractor.h"
#include "objects/feature_tools.h"
#include "scan/ring_profile.h"

namespace lidar_obstacles {
namespace {

constexpr int kMostLooked = 64;  // columns of a ring; of more, every k-th

}  // namespace

/// The deepest notch that a ring shows [m]; 0: none.
float FeatureExtractor::deepestNotch(const RingRun& run, int ring, const Eigen::Vector2f& ahead) const {
    const OrganizedView& view = beams_.cloud().view;
    const int stride = 1 + (run.last - run.first) / kMostLooked;
    std::array<std::pair<int, std::int32_t>, kMostLooked + 1> looked;  // places along the ring, and returns there
    std::size_t n = 0;
    bool jumps = false;
    for (int column = run.first, place = 0; column <= run.last; column += stride, ++place) {
        const std::int32_t i = view.at(ring, viewColumn(static_cast<std::size_t>(column - first_column_)));
        if (i < 0 || !mine(i) || ground_.height[i] >= kBelowWindows) continue;
        jumps |= n > 0 && std::abs(beams_.range(i) - beams_.range(looked[n - 1].second)) > kNotchDepth;
        looked[n++] = {place, i};
    }
    if (!jumps) return 0.0f;
    std::vector<ProfilePoint> profile;
    std::vector<int> places;
    for (std::size_t k = 0; k < n; ++k) {
        const auto [place, i] = looked[k];
        const auto point = profilePointOf((beams_.cloud().xyz[i] - origin_).head<2>(), ahead);
        if (!point) continue;
        profile.push_back(*point);
        places.push_back(place);
    }
    const std::vector<float> depth = depthsOf(profile);
    float deepest = 0.0f;
    for (std::size_t k = 1; k < profile.size(); ++k)
        if (places[k] - places[k - 1] <= kNeighbourColumns)
            deepest = std::max(deepest, notchBetween(profile, depth, k));
    return deepest;
}

/// How deep the notches are, and how many rings show one.
void FeatureExtractor::measureNotches(FeatureVector& f) const {
    constexpr int kFewest = 3;  // returns that can show one
    constexpr float kDeepest = 10.0f;
    const Member& first = members_.front();
    const Eigen::Vector2f middle =
        Eigen::Vector2f(first.x, first.y) + sums_.mean / static_cast<float>(members_.size()) - origin_.head<2>();
    const Eigen::Vector2f ahead = middle.normalized();
    int rings = 0;
    int notched = 0;
    float deepest = 0.0f;
    for (std::size_t ring = 0; ring < runs_.size(); ++ring) {
        if (runs_[ring].returns == 0) continue;
        ++rings;
        if (runs_[ring].returns < kFewest) continue;
        const float depth = deepestNotch(runs_[ring], static_cast<int>(ring), ahead);
        notched += static_cast<int>(depth > kNotchDepth);
        deepest = std::max(deepest, depth);
    }
    at(f, Feature::NotchDepth) = std::min(kDeepest, deepest);
    at(f, Feature::NotchRings) = share(notched, rings);
}

}  // namespace lidar_obstacles
