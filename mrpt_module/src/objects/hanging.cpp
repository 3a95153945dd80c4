// SPDX-License-Identifier: BSD-3-Clause
#include "objects/hanging.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "lidar_obstacles/object_models.h"
#include "objects/footprint.h"
#include "objects/gates.h"
#include "objects/groups.h"

namespace lidar_obstacles {
namespace {

/// The returns of a piece that are higher than something, by their places in the view.
class UpperReturns {
  public:
    UpperReturns(const Cluster& piece, const SurfaceTops& scan, double above) : scan_(scan), cloud_(scan.cloud) {
        for (const std::int32_t i : piece.points)
            if (scan.ground.height[i] > above && listed(cloud_.ring[i], cloud_.view.column_of[i]) == i)
                upper_.push_back(i);
        std::sort(upper_.begin(), upper_.end());
        found_.assign(upper_.size(), 0);
    }

    /// Those below which a beam passed, and what goes on from them upwards and to the sides; rising.
    std::vector<std::int32_t> hanging() {
        std::vector<std::int32_t> found;
        for (std::size_t k = 0; k < upper_.size(); ++k)
            if (passedBelow(scan_, upper_[k])) take(k, found);
        for (std::size_t k = 0; k < found.size(); ++k)
            for (const std::int32_t j : neighboursOf(found[k])) {
                const auto place = std::lower_bound(upper_.begin(), upper_.end(), j);
                if (place != upper_.end() && *place == j) take(static_cast<std::size_t>(place - upper_.begin()), found);
            }
        std::sort(found.begin(), found.end());
        return found;
    }

  private:
    std::int32_t listed(int ring, int column) const { return cloud_.view.at(ring, cloud_.view.wrap(column)); }

    void take(std::size_t k, std::vector<std::int32_t>& found) {
        if (found_[k] == 0) found.push_back(upper_[k]);
        found_[k] = 1;
    }

    /// On its ring and on the next one up, as far from the sensor as it is itself.
    std::vector<std::int32_t> neighboursOf(std::int32_t i) const {
        constexpr int kBeside = 2;      // columns
        constexpr float kDepth = 0.5f;  // [m]
        const auto range = [&](std::int32_t j) { return (cloud_.xyz[j] - cloud_.originOf(j)).head<2>().norm(); };
        const int ring = cloud_.ring[i], column = cloud_.view.column_of[i];
        std::vector<std::int32_t> near;
        const auto add = [&](int other_ring, int other_column) {
            const std::int32_t j = listed(other_ring, other_column);
            if (j >= 0 && std::abs(range(j) - range(i)) < kDepth) near.push_back(j);
        };
        for (int k = 1; k <= kBeside; ++k)
            for (const int side : {-k, k}) add(ring, column + side);
        if (ring + 1 < cloud_.endRing(ring)) add(ring + 1, column);
        return near;
    }

    const SurfaceTops& scan_;
    const PointCloud& cloud_;
    std::vector<std::int32_t> upper_;  ///< rising
    std::vector<std::uint8_t> found_;  ///< of each: does it hang?
};

bool mayHoldBoth(const Cluster& piece, const GroundModel& ground, double max_bottom) {
    const auto is_above = [&](std::int32_t i) { return ground.height[i] > max_bottom; };
    return piece.bottom <= max_bottom && std::any_of(piece.points.begin(), piece.points.end(), is_above);
}

/// Is it no larger than the longest vehicle?
bool mayBeRoadUser(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    const SizeLimits most = sizeLimitsOf(ObstacleClass::Vehicle, std::numeric_limits<float>::max());
    return boundsOf(points, cloud).diagonal().norm() <= std::hypot(most.max_length, most.max_width);
}

}  // namespace

FeatureVector HangingParts::measured(const std::vector<std::int32_t>& points) {
    Hypothesis h;
    h.points = points;
    FeatureVector f = featuresOf_(h, footprintOf(points, scan_.cloud));
    measureParts(h, {}, f);
    return f;
}

/// Pieces of which an upper part may hang.
std::vector<HangingParts::Candidate> HangingParts::candidatesOf(std::vector<Cluster>& pieces) {
    std::vector<Candidate> candidates;
    for (Cluster& piece : pieces) {
        if (!mayHoldBoth(piece, scan_.ground, params_.max_bottom)) continue;
        Candidate c;
        c.piece = &piece;
        c.upper = UpperReturns(piece, scan_, params_.max_bottom).hanging();
        if (static_cast<int>(c.upper.size()) < params_.min_points) continue;
        std::sort(piece.points.begin(), piece.points.end());
        std::set_difference(piece.points.begin(), piece.points.end(), c.upper.begin(), c.upper.end(),
                            std::back_inserter(c.rest));
        if (c.rest.size() < kSpeck || !mayBeRoadUser(c.rest, scan_.cloud)) continue;
        c.features = {measured(piece.points), measured(c.rest)};
        candidates.push_back(std::move(c));
    }
    return candidates;
}

void HangingParts::takeOut(std::vector<Cluster>& pieces, std::vector<RejectedCluster>& rejected) {
    if (scan_.cloud.view.empty()) return;
    std::vector<Candidate> candidates = candidatesOf(pieces);
    std::vector<const FeatureVector*> asked;
    for (const Candidate& c : candidates)
        for (const FeatureVector& f : c.features) asked.push_back(&f);
    const std::vector<CategoryProbabilities> told = recognizer_(asked, Recognizer::Forest::Grouping);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        Candidate& c = candidates[k];
        Hypothesis both, lower;
        both.points = c.piece->points;
        lower.points = c.rest;
        setScore(both, told[2 * k], {});
        setScore(lower, told[2 * k + 1], {});
        if (lower.cut <= both.cut) continue;  // as many returns in a whole object with the upper part
        c.piece->points = std::move(c.rest);
        Cluster upper;
        upper.points = std::move(c.upper);
        const float bottom = upper.bottom = bottomOf(upper.points, scan_.ground);
        rejected.push_back({std::move(upper), RejectReason::Floating, bottom, params_.max_bottom});
    }
}

}  // namespace lidar_obstacles
