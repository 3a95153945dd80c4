// SPDX-License-Identifier: BSD-3-Clause
#include "objects/hanging.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/object_models.h"
#include "objects/footprint.h"
#include "objects/gates.h"
#include "objects/groups.h"
#include "scan/listed.h"

namespace lidar_obstacles {

HangingReturns::HangingReturns(const SurfaceTops& scan, const std::vector<std::int32_t>& returns, double above)
    : part_(scan.cloud.size(), kOther) {
    if (scan.cloud.view.empty()) return;
    std::vector<std::int32_t> upper;
    for (const std::int32_t i : returns) {
        if (!(scan.ground.height[i] > above) || !isListed(scan.cloud, i)) continue;
        part_[i] = kUpper;
        upper.push_back(i);
    }
    for (const std::int32_t i : upper)
        if (part_[i] == kUpper && passedBelow(scan, i)) mostly_.push_back(floats(grow(scan.cloud, i), scan));
}

std::vector<std::int32_t> HangingReturns::grow(const PointCloud& cloud, std::int32_t first) {
    constexpr int kBeside = 2;      // columns
    constexpr float kDepth = 0.5f;  // as far from the sensor [m]
    std::vector<std::int32_t> part{first};
    const auto number = static_cast<std::int32_t>(mostly_.size());
    part_[first] = number;
    const auto range = [&](std::int32_t i) { return (cloud.xyz[i] - cloud.originOf(i)).head<2>().norm(); };
    for (std::size_t next = 0; next < part.size(); ++next) {
        const int ring = cloud.ring[part[next]], column = cloud.view.column_of[part[next]];
        const float from = range(part[next]);
        const auto take = [&](int other_ring, int other_column) {
            const std::int32_t j = cloud.view.at(other_ring, cloud.view.wrap(other_column));
            if (j < 0 || part_[j] != kUpper || std::abs(range(j) - from) >= kDepth) return;
            part_[j] = number;
            part.push_back(j);
        };
        for (int k = 1; k <= kBeside; ++k)
            for (const int side : {-k, k}) take(ring, column + side);
        if (ring + 1 < cloud.endRing(ring)) take(ring + 1, column);
    }
    return part;
}

std::array<std::vector<std::int32_t>, 2> HangingReturns::partsOf(const std::vector<std::int32_t>& points,
                                                                 Proof proof) const {
    std::array<std::vector<std::int32_t>, 2> parts;
    for (const std::int32_t i : points) {
        const bool hangs = part_[i] >= 0 && (proof == Proof::Some || mostly_[static_cast<std::size_t>(part_[i])]);
        parts[hangs ? 0 : 1].push_back(i);
    }
    return parts;
}

namespace {

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

void partAtHanging(std::vector<Cluster>& clusters, const HangingReturns& hanging, const GroundModel& ground,
                   const GateParams& params) {
    std::vector<Cluster> upper;
    for (Cluster& c : clusters) {
        if (!mayHoldBoth(c, ground, params.max_bottom)) continue;
        auto [above, rest] = hanging.partsOf(c.points, HangingReturns::Proof::Most);
        if (static_cast<int>(above.size()) < params.min_points || rest.empty()) continue;
        c.points = std::move(rest);
        upper.push_back(c);
        upper.back().points = std::move(above);
        upper.back().bottom = bottomOf(upper.back().points, ground);
        upper.back().hangs = true;
    }
    std::move(upper.begin(), upper.end(), std::back_inserter(clusters));
}

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
        auto [upper, rest] = hanging_.partsOf(piece.points, HangingReturns::Proof::Some);
        c.upper = std::move(upper);
        c.rest = std::move(rest);
        if (static_cast<int>(c.upper.size()) < params_.min_points) continue;
        if (c.rest.size() < kSpeck || !mayBeRoadUser(c.rest, scan_.cloud)) continue;
        c.features = {measured(piece.points), measured(c.rest), measured(c.upper)};
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
        std::array<Hypothesis, 3> h;
        h[0].points = c.piece->points;
        h[1].points = c.rest;
        h[2].points = c.upper;
        for (std::size_t j = 0; j < h.size(); ++j) setScore(h[j], told[h.size() * k + j], {});
        const auto& [both, lower, upper_part] = h;
        const bool road_user = isRoadUser(topClass(lower.probability)) && lower.whole > 0.5f;
        const bool counts = road_user && c.upper.size() >= kSpeck;
        if (lower.cut + (counts ? upper_part.cut : 0.0f) <= both.cut) continue;
        c.piece->points = std::move(c.rest);
        Cluster upper;
        upper.points = std::move(c.upper);
        const float bottom = upper.bottom = bottomOf(upper.points, scan_.ground);
        rejected.push_back({std::move(upper), RejectReason::Floating, bottom, params_.max_bottom});
    }
}

}  // namespace lidar_obstacles
