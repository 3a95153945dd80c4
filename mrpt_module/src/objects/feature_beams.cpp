// SPDX-License-Identifier: BSD-3-Clause
// The features that beams prove.
#include <algorithm>
#include <cmath>

#include "lidar_obstacles/feature_extractor.h"
#include "lidar_obstacles/object_models.h"
#include "objects/feature_tools.h"

namespace lidar_obstacles {

/// What the beams of one column show.
struct FeatureExtractor::ColumnEvidence {
    int hits = 0, through = 0, under = 0, hidden = 0;
    bool ground_inside = false;
    bool floating = false;   ///< the next beam down passed below it
    bool goes_up = false;    ///< the next beam up hit the same surface
    bool goes_down = false;  ///< the next beam down did
};

/// One beam that is not the group's, seen from what was hit in its column.
inline void FeatureExtractor::weighBeam(std::int32_t j, const Column& c, float bottom, ColumnEvidence& e) const {
    const float range = beams_.range(j);
    const bool ground = ground_.is_ground[j] != 0;
    e.ground_inside |= ground && range > c.near + 0.3f && range < c.far - 0.3f;
    if (range > c.far + kBehind) {
        const float height = ground_.height[j] + (beams_.beamHeight(j, c.far) - beams_.cloud().xyz[j].z());
        ++(height < bottom ? e.under : e.through);
    } else if (range < c.near - kBehind && !ground) {
        ++e.hidden;
    }
}

/// The first return of a column from a ring on, upwards or downwards; -1: none.
std::int32_t FeatureExtractor::firstFrom(int ring, int step, int column) const {
    const OrganizedView& view = beams_.cloud().view;
    for (; ring >= first_ring_ && ring < end_ring_; ring += step)
        if (const std::int32_t j = view.at(ring, column); j >= 0) return j;
    return -1;
}

FeatureExtractor::ColumnEvidence FeatureExtractor::evidenceOf(const Column& c, int column, float bottom) const {
    ColumnEvidence e;
    const int high = c.high_ring;
    for (int ring = high; ring >= first_ring_; --ring) {
        const std::int32_t j = beams_.cloud().view.at(ring, column);
        if (j < 0) continue;
        if (mine(j))
            ++e.hits;
        else
            weighBeam(j, c, bottom, e);
    }
    if (const std::int32_t j = firstFrom(c.low_ring - 1, -1, column); j >= 0 && !mine(j)) {
        e.floating = beams_.range(j) > c.near + kBehind;
        e.goes_down = ground_.is_ground[j] == 0 && std::abs(beams_.range(j) - beams_.range(c.lowest)) <= kBehind;
    }
    if (const std::int32_t j = firstFrom(high + 1, 1, column); j >= 0)
        e.goes_up = !mine(j) && std::abs(beams_.range(j) - beams_.range(c.highest)) <= kBehind;
    return e;
}

/// What the beams of its columns show: through it, below it, in front of it, above and below its surface.
void FeatureExtractor::measureColumns(FeatureVector& f) const {
    int looked_at = 0, inside = 0, floating = 0, up = 0, down = 0;
    ColumnEvidence sum;
    const std::size_t stride = 1 + columns_.size() / kMostColumns;
    for (std::size_t k = 0; k < columns_.size(); k += stride) {
        if (!columns_[k].hit()) continue;
        ++looked_at;
        const ColumnEvidence e = evidenceOf(columns_[k], viewColumn(k), at(f, Feature::Bottom));
        sum.hits += e.hits;
        sum.through += e.through;
        sum.under += e.under;
        sum.hidden += e.hidden;
        inside += static_cast<int>(e.ground_inside);
        floating += static_cast<int>(e.floating);
        up += static_cast<int>(e.goes_up);
        down += static_cast<int>(e.goes_down);
    }
    at(f, Feature::Through) = share(sum.through, sum.through + sum.hits);
    at(f, Feature::Under) = share(sum.under, looked_at);
    at(f, Feature::Hidden) = share(sum.hidden, sum.hidden + sum.hits);
    at(f, Feature::GroundInside) = share(inside, looked_at);
    at(f, Feature::Floating) = share(floating, looked_at);
    at(f, Feature::GoesUp) = share(up, looked_at);
    at(f, Feature::GoesDown) = share(down, looked_at);
}

/// What the beams of a column show in which nothing of the group was hit, where it would be `line` away.
FeatureExtractor::Between FeatureExtractor::lookBetween(int column, float line, float highest) const {
    constexpr float kBelly = 0.3f;
    const PointCloud& cloud = beams_.cloud();
    Between seen = Between::Nothing;
    for (int ring = first_ring_; ring < end_ring_; ++ring) {
        const std::int32_t j = cloud.view.at(ring, column);
        if (j < 0) continue;
        const float height = ground_.height[j] + beams_.beamHeight(j, line) - cloud.xyz[j].z();
        if (height > highest) break;
        if (beams_.range(j) > line + kBehind) {
            if (height > kBelly) return Between::Free;
        } else if (beams_.range(j) < line - kBehind && ground_.is_ground[j] == 0) {
            seen = Between::Hidden;
        }
    }
    return seen;
}

/// What the beams show between the columns in which it was hit: a gap that they passed parts two things; one that
/// something nearer hides does not.
void FeatureExtractor::measureGaps(FeatureVector& f) const {
    constexpr std::size_t kMostGaps = 96;  // columns that are looked at; of more, every k-th
    const float highest = std::min(static_cast<float>(kVehicleWindows), at(f, Feature::Top) - 0.2f);
    const auto empty = static_cast<int>(std::count_if(columns_.begin(), columns_.end(),  //
                                                      [](const Column& c) { return !c.hit(); }));
    const std::size_t stride = 1 + static_cast<std::size_t>(empty) / kMostGaps;
    int looked_at = 0, free = 0, hidden = 0;
    std::size_t last = 0, next = 0;  // that were hit, before and behind; the first and the last column were
    std::size_t passed = 0;
    for (std::size_t k = 0; k < columns_.size(); k += columns_[k].hit() ? 1 : stride) {
        if (columns_[k].hit()) continue;
        for (; passed < k; ++passed)
            if (columns_[passed].hit()) last = passed;
        for (next = std::max(next, k); !columns_[next].hit();) ++next;
        const auto to_last = static_cast<float>(k - last);
        const float way = to_last / (to_last + static_cast<float>(next - k));
        const float near = columns_[last].near;
        const Between seen = lookBetween(viewColumn(k), near + way * (columns_[next].near - near), highest);
        ++looked_at;
        free += static_cast<int>(seen == Between::Free);
        hidden += static_cast<int>(seen == Between::Hidden);
    }
    const float width = at(f, Feature::Range) * beams_.azimuthStep() * share(empty, std::max(1, looked_at));
    at(f, Feature::GapShare) = share(empty, static_cast<int>(columns_.size()));
    at(f, Feature::GapFree) = std::min(kFarAway, width * static_cast<float>(free));
    at(f, Feature::GapHidden) = std::min(kFarAway, width * static_cast<float>(hidden));
}

/// What stands beside it, ring by ring: the same surface, something nearer, or nothing.
void FeatureExtractor::measureEnds(FeatureVector& f) const {
    std::array<int, 2> on{}, hidden{};
    int rings = 0;
    for (const RingRun& run : runs_) {
        if (run.returns == 0) continue;
        ++rings;
        for (std::size_t side = 0; side < 2; ++side) {
            const std::int32_t end = side == 0 ? run.from : run.to;
            const std::int32_t j = beams_.beside(end, side == 0 ? -1 : 1);
            if (j < 0 || ground_.is_ground[j] != 0) continue;
            const float apart = beams_.range(j) - beams_.range(end);
            const float same = 0.3f + 0.02f * beams_.range(end);
            if (std::abs(apart) <= same)
                ++on[side];
            else if (apart < 0.0f)
                ++hidden[side];
        }
    }
    at(f, Feature::GoesOnMore) = share(std::max(on[0], on[1]), rings);
    at(f, Feature::GoesOnLess) = share(std::min(on[0], on[1]), rings);
    at(f, Feature::HiddenMore) = share(std::max(hidden[0], hidden[1]), rings);
    at(f, Feature::HiddenLess) = share(std::min(hidden[0], hidden[1]), rings);
}

}  // namespace lidar_obstacles
