// SPDX-License-Identifier: BSD-3-Clause
#include "ground/ground_runs.h"

#include <algorithm>
#include <cmath>

#include "ground/ground_ring.h"
#include "scan/listed.h"

namespace lidar_obstacles {
namespace {

constexpr float kMinStep = 0.2f;  // higher than a kerb [m]
constexpr int kBoundGap = 25;  // columns without a return that may lie beside a run: far ground often returns nothing

/// A stretch of neighbouring returns of ground without steps: columns [first, last].
struct Run {
    int first = 0;
    int last = 0;
};

/// Does a return lie in front of another one, of the ground: a drop or a pole, which does not end the ground?
bool inFront(const GroundRing& ring, std::int32_t i, std::int32_t ground) {
    return !ring.isGroundReturn(i) && ring.step(i, ground) > GroundRing::kSmooth;
}

Run runFrom(const GroundRing& ring, int column) {
    Run run{column, column};
    std::int32_t last = ring.at(column);
    for (int next = column + 1; next < column + ring.columns && next <= run.last + GroundRing::kGap; ++next) {
        const std::int32_t i = ring.at(next);
        if (i < 0 || inFront(ring, i, last)) continue;
        if (!ring.goesOn(last, i)) break;
        run.last = next;
        last = i;
    }
    return run;
}

/// A column where a run begins, so that none is cut by the seam of the scan; 0 if there is none.
int firstBegin(const GroundRing& ring) {
    for (int column = 0; column < ring.columns; ++column) {
        if (!ring.has(column) || !ring.isGround(column)) continue;
        int before = column - 1;
        while (before >= column - GroundRing::kGap &&
               (!ring.has(before) || inFront(ring, ring.at(before), ring.at(column))))
            --before;
        if (before < column - GroundRing::kGap || !ring.goesOn(ring.at(before), ring.at(column))) return column;
    }
    return 0;
}

/// What lies beside a run.
enum class Bound { Level, StepDown, Open };

/// Does the ground at a column go on away from a run, farther than a run may skip? What lies below the ground for a few
/// columns only is a mirror image: a shot that a puddle sent on.
bool goesOnAway(const GroundRing& ring, int column, int direction) {
    std::int32_t last = ring.at(column);
    for (int k = 1; k <= kBoundGap; ++k) {
        const int next = column + direction * k;
        if (!ring.has(next) || inFront(ring, ring.at(next), last)) continue;
        if (!ring.goesOn(last, ring.at(next))) return false;
        if (k > GroundRing::kGap) return true;
        last = ring.at(next);
    }
    return false;
}

Bound boundOf(const GroundRing& ring, int column, int direction) {
    for (int k = 1; k <= kBoundGap; ++k) {
        const int beside = column + direction * k;
        if (!ring.has(beside)) continue;
        if (!ring.isGround(beside)) return Bound::Open;
        if (ring.step(ring.at(column), ring.at(beside)) <= kMinStep) return Bound::Level;
        if (goesOnAway(ring, beside, direction)) return Bound::StepDown;
    }
    return Bound::Open;
}

bool stands(const PointCloud& cloud, const GroundRing& ring, const Run& run) {
    constexpr float kMaxLength = 7.0f;
    if ((cloud.xyz[ring.at(run.first)] - cloud.xyz[ring.at(run.last)]).norm() > kMaxLength) return false;
    const Bound left = boundOf(ring, run.first, -1);
    const Bound right = boundOf(ring, run.last, 1);
    return left != Bound::Level && right != Bound::Level && (left == Bound::StepDown || right == Bound::StepDown);
}

}  // namespace

void keepStandingRuns(const PointCloud& cloud, GroundModel& model) {
    for (int r = 0; r < cloud.view.rings; ++r) {
        const GroundRing ring(cloud, model, r);
        if (!ring.meetsGround()) continue;
        const int begin = firstBegin(ring);
        for (int column = begin; column < begin + ring.columns; ++column) {
            const std::int32_t i = ring.at(column);
            if (i < 0 || !ring.isGroundReturn(i)) continue;
            const Run run = runFrom(ring, column);
            column = run.last;
            if (!stands(cloud, ring, run)) continue;
            for (int k = run.first; k <= run.last; ++k)
                if (ring.has(k)) model.is_ground[ring.at(k)] = 0;
        }
    }
}

namespace {

/// Does the next ring up hit something steep right over return i, at its column or a neighbouring one?
bool carries(const PointCloud& cloud, const GroundModel& model, std::int32_t i, int next_ring) {
    constexpr float kMinRise = 0.10f;
    for (int step = -1; step <= 1; ++step) {
        const std::int32_t j = cloud.view.at(next_ring, cloud.view.wrap(cloud.view.column_of[i] + step));
        if (j < 0 || model.is_ground[j]) continue;
        const float rise = model.height[j] - model.height[i];
        const float run = (cloud.xyz[j].head<2>() - cloud.xyz[i].head<2>()).norm();
        if (rise > kMinRise && run < 0.15f + 0.3f * rise) return true;
    }
    return false;
}

}  // namespace

void keepFeetOfObstacles(const PointCloud& cloud, GroundModel& model) {
    constexpr float kMinHeight = 0.08f;  // nearer to the plane it may well be the ground in front of the obstacle
    std::vector<std::int32_t> feet;
    for (std::size_t k = 0; k < cloud.view.column_of.size(); ++k) {
        // one branch for both: each is common, together they are rare
        const int raised = static_cast<int>(model.height[k] >= kMinHeight) & static_cast<int>(model.is_ground[k]);
        if (raised == 0 || cloud.ring[k] + 1 >= cloud.endRing(cloud.ring[k])) continue;
        const auto i = static_cast<std::int32_t>(k);
        // not a farther return in the same place of the view
        if (!isListed(cloud, i)) continue;
        if (carries(cloud, model, i, cloud.ring[k] + 1)) feet.push_back(i);
    }
    for (const std::int32_t i : feet) model.is_ground[i] = 0;
}

}  // namespace lidar_obstacles
