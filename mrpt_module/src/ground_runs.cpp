#include "ground_runs.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr float kSmooth = 0.12f;  // between neighbouring returns of one run [m]
constexpr float kMinStep = 0.2f;  // higher than a kerb [m]
constexpr int kRunGap = 6;        // columns without a return that a run may skip
constexpr int kBoundGap = 25;     // ... that may lie beside it: far ground often returns nothing

/// One plane of the scan: its returns by column, and the labels. Columns go around the circle: -1 is the last one, and
/// `columns` is the first again.
struct Ring {
    const std::int32_t* index;
    int columns;
    const GroundModel& model;

    std::int32_t at(int column) const {
        while (column >= columns) column -= columns;
        while (column < 0) column += columns;
        return index[column];
    }
    bool has(int column) const { return at(column) >= 0; }
    bool isGround(int column) const { return model.is_ground[at(column)] != 0; }
    float height(int column) const { return model.height[at(column)]; }
    /// Is there ground in both columns, without a step in between?
    bool goesOn(int from, int to) const {
        return isGround(from) && isGround(to) && std::abs(height(from) - height(to)) <= kSmooth;
    }
};

/// A stretch of neighbouring returns of ground without steps: columns [first, last].
struct Run {
    int first = 0;
    int last = 0;
};

Run runFrom(const Ring& ring, int column) {
    Run run{column, column};
    for (int next = column + 1; next < column + ring.columns && next <= run.last + kRunGap; ++next) {
        if (!ring.has(next)) continue;
        if (!ring.goesOn(run.last, next)) break;
        run.last = next;
    }
    return run;
}

/// A column where a run begins, so that none is cut by the seam of the scan; 0 if there is none.
int firstBegin(const Ring& ring) {
    for (int column = 0; column < ring.columns; ++column) {
        if (!ring.has(column) || !ring.isGround(column)) continue;
        int before = column - 1;
        while (before >= column - kRunGap && !ring.has(before)) --before;
        if (before < column - kRunGap || !ring.goesOn(before, column)) return column;
    }
    return 0;
}

/// What lies beside a run.
enum class Bound { Level, StepDown, Open };

Bound boundOf(const Ring& ring, int column, int direction) {
    for (int k = 1; k <= kBoundGap; ++k) {
        const int beside = column + direction * k;
        if (!ring.has(beside)) continue;
        if (!ring.isGround(beside)) return Bound::Open;
        const float step = ring.height(column) - ring.height(beside);
        return step > kMinStep ? Bound::StepDown : Bound::Level;
    }
    return Bound::Open;
}

bool stands(const PointCloud& cloud, const Ring& ring, const Run& run) {
    constexpr float kMaxLength = 7.0f;
    if ((cloud.xyz[ring.at(run.first)] - cloud.xyz[ring.at(run.last)]).norm() > kMaxLength) return false;
    const Bound left = boundOf(ring, run.first, -1);
    const Bound right = boundOf(ring, run.last, 1);
    return left != Bound::Level && right != Bound::Level && (left == Bound::StepDown || right == Bound::StepDown);
}

}  // namespace

void keepStandingRuns(const PointCloud& cloud, GroundModel& model) {
    for (int r = 0; r < cloud.view.rings; ++r) {
        const Ring ring{&cloud.view.index[static_cast<std::size_t>(r) * cloud.view.columns], cloud.view.columns, model};
        const int begin = firstBegin(ring);
        for (int column = begin; column < begin + ring.columns; ++column) {
            if (!ring.has(column) || !ring.isGround(column)) continue;
            const Run run = runFrom(ring, column);
            column = run.last;
            if (!stands(cloud, ring, run)) continue;
            for (int k = run.first; k <= run.last; ++k)
                if (ring.has(k)) model.is_ground[ring.at(k)] = 0;
        }
    }
}

namespace {

/// Does the next plane up hit something steep right over return i, at its column or a neighbouring one?
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
    for (int ring = 0; ring + 1 < cloud.view.rings; ++ring) {
        const std::int32_t* row = &cloud.view.index[static_cast<std::size_t>(ring) * cloud.view.columns];
        for (int column = 0; column < cloud.view.columns; ++column) {
            const std::int32_t i = row[column];
            if (i < 0 || model.height[i] < kMinHeight || !model.is_ground[i]) continue;
            if (carries(cloud, model, i, ring + 1)) model.is_ground[i] = 0;
        }
    }
}

}  // namespace lidar_obstacles
