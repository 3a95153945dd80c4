// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "ground/ground_ring.h"
#include "ground/ground_runs.h"

namespace lidar_obstacles {
namespace {

/// A ring of the scan and the lengths of its beams.
class RingBeams {
  public:
    explicit RingBeams(const GroundRing& r) : ring(r), squared_(r.columns + 2 * GroundRing::kGap) {
        constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
        for (int column = -GroundRing::kGap; column < r.columns + GroundRing::kGap; ++column) {
            const std::int32_t i = r.at(column);
            squared_[column + GroundRing::kGap] = i >= 0 ? r.squaredLength(i) : kNone;
        }
        for (int k = 1; k <= GroundRing::kGap; ++k)
            level_[k] = r.levelRatio(std::min(GroundRing::kSmooth, kBend * static_cast<float>(k)));
    }

    /// Squared length of the beam of a column and of those up to kGap columns beside it [m^2]; NaN where there is none.
    const float* squared(int column) const { return &squared_[ring.wrapped(column) + GroundRing::kGap]; }
    /// Up to which ratio of their squared lengths beams so many columns apart end level.
    float level(int columns) const { return level_[columns]; }

    const GroundRing& ring;

  private:
    static constexpr float kBend = 0.03f;  // from column to column [m]

    std::vector<float> squared_;
    std::array<float, GroundRing::kGap + 1> level_{};
};

/// What comes after a return of a run along its ring.
struct Next {
    int column = 0;       ///< of the return that goes on without a step, where there is one
    bool smooth = false;  ///< there is one
    bool hidden = false;  ///< there is none, and something nearer may hide it
};

/// @param direction  1 or -1. What is nearer (a drop, a pole) is looked past.
Next nextOf(const RingBeams& beams, int column, int direction) {
    const float* squared = beams.squared(column);
    const float own = *squared;
    Next next;
    for (int k = 1; k <= GroundRing::kGap; ++k) {
        const float other = squared[direction * k];
        if (std::isnan(other)) continue;
        const float ratio = beams.level(k);
        if (other <= own * ratio && own <= other * ratio) return {column + direction * k, true, false};
        if (other > own) return {};
        next.hidden = true;
    }
    return next;
}

/// Returns without a step in between that are not labelled ground: their columns, and what is at either end.
struct Run {
    std::vector<int> columns;
    Next before;
    Next after;
};

/// @param run  is written over: it is asked for thousands of times a scan, and keeps its memory so.
void runFrom(const RingBeams& beams, int column, Run& run) {
    run.before = nextOf(beams, column, -1);
    run.after = {};
    run.columns.clear();
    run.columns.push_back(column);
    while (static_cast<int>(run.columns.size()) < beams.ring.columns) {
        run.after = nextOf(beams, run.columns.back(), 1);
        if (!run.after.smooth || beams.ring.isGround(run.after.column)) break;
        run.columns.push_back(run.after.column);
    }
}

/// Does the ground that a run leads to go on from there? The lower end of a hood is labelled ground as well, but it is
/// short.
bool reachesGround(const RingBeams& beams, const Next& end, int direction) {
    constexpr float kLength = 3.0f;  // [m]
    const GroundRing& ring = beams.ring;
    for (Next next = end;
         next.smooth && ring.isGround(next.column) && std::abs(next.column - end.column) < ring.columns;
         next = nextOf(beams, next.column, direction))
        if ((ring.point(next.column) - ring.point(end.column)).norm() > kLength) return true;
    return false;
}

bool joinsGround(const RingBeams& beams, const Run& run) {
    if (run.before.smooth && run.after.smooth) return true;
    if (run.before.hidden) return reachesGround(beams, run.after, 1);
    return run.after.hidden && reachesGround(beams, run.before, -1);
}

/// The way from one return to a higher one: how far up and how far away from the sensor [m].
struct Climb {
    float rise = 0.0f;
    float run = 0.0f;

    bool steeperThan(float slope) const {
        constexpr float kMinRise = 0.1f;
        return rise > kMinRise && rise > slope * run;
    }
};

Climb climb(const PointCloud& cloud, const GroundModel& model, std::int32_t low, std::int32_t high) {
    const auto range = [&](std::int32_t i) { return (cloud.xyz[i] - cloud.originOf(i)).head<2>().norm(); };
    return {model.height[high] - model.height[low], range(high) - range(low)};
}

/// Does something too steep for ground lead up to a return from the ring below, or on from it to the ring above?
bool onSteep(const PointCloud& cloud, const GroundModel& model, std::int32_t i) {
    constexpr float kSteepRise = 0.2f;   // rise over run, from the ground before it
    constexpr float kSteepWall = 0.47f;  // to what is behind it (25 deg)
    const int ring = cloud.ring[i];
    const int column = cloud.view.column_of[i];
    const std::int32_t below = ring > cloud.firstRing(ring) ? cloud.view.at(ring - 1, column) : -1;
    const std::int32_t above = ring + 1 < cloud.endRing(ring) ? cloud.view.at(ring + 1, column) : -1;
    return (below >= 0 && climb(cloud, model, below, i).steeperThan(kSteepRise)) ||
           (above >= 0 && climb(cloud, model, i, above).steeperThan(kSteepWall));
}

bool isGentle(const PointCloud& cloud, const GroundModel& model, const GroundRing& ring, const Run& run) {
    constexpr std::ptrdiff_t kSteepShare = 5;  // one in so many
    const auto steep = std::count_if(run.columns.begin(), run.columns.end(),
                                     [&](int column) { return onSteep(cloud, model, ring.at(column)); });
    return kSteepShare * steep <= static_cast<std::ptrdiff_t>(run.columns.size());
}

}  // namespace

void followRisingGround(const PointCloud& cloud, GroundModel& model) {
    Run run;
    for (int r = 0; r < cloud.view.rings; ++r) {
        const GroundRing ring(cloud, model, r);
        if (!ring.meetsGround()) continue;
        const RingBeams beams(ring);
        for (int column = 0; column < ring.columns; ++column) {
            const std::int32_t i = ring.at(column);
            if (i < 0 || ring.isGroundReturn(i)) continue;
            const Next before = nextOf(beams, column, -1);
            if (!before.smooth && !before.hidden) continue;
            if (before.smooth && !ring.isGround(before.column)) continue;  // not the first of its run
            runFrom(beams, column, run);
            if (!joinsGround(beams, run) || !isGentle(cloud, model, ring, run)) continue;
            for (const int c : run.columns) model.is_ground[ring.at(c)] = 1;
        }
    }
}

}  // namespace lidar_obstacles
