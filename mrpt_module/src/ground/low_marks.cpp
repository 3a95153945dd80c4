// SPDX-License-Identifier: BSD-3-Clause
#include "ground/low_marks.h"

#include <algorithm>

namespace lidar_obstacles {
namespace {

constexpr int kGap = 3;          // columns from return to return of one run at most
constexpr int kLook = 10;        // columns to the run beside
constexpr int kFewestOfRun = 3;  // returns of a run that counts
constexpr float kEdge = 0.5f;    // this near to a step returns of the raised side belong to it [m]

enum : std::uint8_t { kNoMark, kRaised, kDrop };

/// What each cell shows.
struct Marks {
    explicit Marks(const NearGround& n) : near(n), of(static_cast<std::size_t>(n.rings()) * n.columns(), kNoMark) {}
    std::uint8_t& at(int ring, int column) { return of[static_cast<std::size_t>(ring) * near.columns() + column]; }

    const NearGround& near;
    std::vector<std::uint8_t> of;
};

/// Neighbouring beams of a ring: columns from first to last. What goes on across column 0 ends beyond the last column:
/// see NearGround::wrap().
struct LowRun {
    int first = 0, last = 0, beams = 0;
};

/// Runs all around. @param isPart  of a column. @param goesOn  does what ends at a column go on at a later one?
template <class IsPart, class GoesOn>
std::vector<LowRun> runsAround(int columns, const IsPart& isPart, const GoesOn& goesOn) {
    std::vector<LowRun> runs;
    runs.reserve(64);
    for (int column = 0; column < columns; ++column) {
        if (!isPart(column)) continue;
        if (!runs.empty() && goesOn(runs.back().last, column)) {
            runs.back().last = column;
            ++runs.back().beams;
        } else {
            runs.push_back({column, column, 1});
        }
    }
    if (runs.size() > 1 && goesOn(runs.back().last, runs.front().first + columns)) {
        runs.back().last = runs.front().last + columns;
        runs.back().beams += runs.front().beams;
        runs.erase(runs.begin());
    }
    return runs;
}

/// Returns side by side without a step in between.
std::vector<LowRun> runsOf(const NearGround& near, int ring) {
    const auto goesOn = [&](int last, int next) {
        const float rise = near.at(ring, near.wrap(next)).height - near.at(ring, last).height;
        return next - last <= kGap && std::abs(rise) <= 0.5f * near.step();
    };
    std::vector<LowRun> runs =
        runsAround(near.columns(), [&](int column) { return near.isNear(near.at(ring, column)); }, goesOn);
    runs.erase(std::remove_if(runs.begin(), runs.end(), [](const LowRun& r) { return r.beams < kFewestOfRun; }),
               runs.end());
    return runs;
}

/// An end of a run and the end of the run beside it.
struct LowEdge {
    int own = 0, beside = 0;  ///< columns, wrapped
    const LowRun& other;
};

void markRaised(Marks& marks, int ring, const LowRun& run, const LowEdge& edge) {
    const NearGround& near = marks.near;
    const Eigen::Vector2f end = near.place(edge.own, near.at(ring, edge.own).range);
    for (int k = run.first; k <= run.last; ++k) {
        const int column = near.wrap(k);
        const NearGround::Cell& cell = near.at(ring, column);
        if (!near.isNear(cell) || cell.height > near.tallest() || near.isFoot(ring, column)) continue;
        if ((near.place(column, cell.range) - end).norm() <= kEdge) marks.at(ring, column) = kRaised;
    }
}

void markLower(Marks& marks, int ring, const LowRun& run) {
    for (int k = run.first; k <= run.last; ++k) {
        const int column = marks.near.wrap(k);
        const NearGround::Cell& cell = marks.near.at(ring, column);
        if (marks.near.isNear(cell) && cell.height <= -marks.near.step()) marks.at(ring, column) = kDrop;
    }
}

/// Is a run ground that others of its kind lead to? The foot of a thing stands higher than ground that falls off behind
/// it.
bool isGround(const NearGround& near, int ring, const LowRun& run) {
    constexpr float kShort = 1.0f;  // [m]
    constexpr int kOddShare = 5;    // one in so many
    const Eigen::Vector2f first = near.place(run.first, near.at(ring, run.first).range);
    float length = 0.0f;  // not from end to end: a run around the sensor ends where it began
    int odd = 0, returns = 0;
    for (int k = run.first; k <= run.last; ++k) {
        const int column = near.wrap(k);
        const NearGround::Cell& cell = near.at(ring, column);
        if (!near.isNear(cell)) continue;
        ++returns;
        length = std::max(length, (near.place(column, cell.range) - first).norm());
        const NearGround::Cell* below = ring > 0 ? &near.at(ring - 1, column) : nullptr;
        const bool steps = below != nullptr && below->isReturn() &&
                           std::abs(cell.height - below->height) >
                               0.5f * near.step() + near.steepest() * std::abs(cell.range - below->range);
        odd += static_cast<int>(steps || near.isFoot(ring, column));
    }
    return length >= kShort && kOddShare * odd <= returns;
}

/// A step from the run beside up to this one, or down to it.
void lookAtEdge(Marks& marks, int ring, const LowRun& run, const LowEdge& edge) {
    const NearGround& near = marks.near;
    const NearGround::Cell &own = near.at(ring, edge.own), &beside = near.at(ring, edge.beside);
    const float step = near.step();
    if (!near.isLevel(beside)) return;
    if (own.height - beside.height >= step && own.height >= 0.5f * step && own.height <= near.tallest())
        markRaised(marks, ring, run, edge);
    else if (beside.height - own.height >= step && own.height <= -step && isGround(near, ring, edge.other))
        markLower(marks, ring, run);
}

/// Steps along a ring: beams side by side of which one is cut short, or flies on.
void lookAlongRings(Marks& marks) {
    for (int ring = 0; ring < marks.near.rings(); ++ring) {
        const std::vector<LowRun> runs = runsOf(marks.near, ring);
        for (std::size_t k = 0; runs.size() > 1 && k < runs.size(); ++k) {
            const bool around = k + 1 == runs.size();
            const LowRun &a = runs[k], &b = runs[around ? 0 : k + 1];
            if (b.first + (around ? marks.near.columns() : 0) - a.last > kLook) continue;
            const int last = marks.near.wrap(a.last);
            lookAtEdge(marks, ring, a, {last, b.first, b});
            lookAtEdge(marks, ring, b, {b.first, last, a});
        }
    }
}

/// One column from the lowest ring outwards.
class Outwards {
  public:
    Outwards(Marks& marks, int column) : marks_(marks), near_(marks.near), column_(column) {}

    void walk() {
        for (int ring = 0; ring < near_.rings(); ++ring)
            if (near_.isNear(near_.at(ring, column_)) && !take(ring)) return;
    }

  private:
    /// False where nothing can be said of what is behind.
    bool take(int ring) {
        const NearGround::Cell& cell = near_.at(ring, column_);
        if (cell.height > near_.tallest()) return false;
        if (ground_ == nullptr) {
            if (near_.isLevel(cell)) ground_ = &cell;
            return true;
        }
        if (face_ >= 0 && cell.height - below_ >= near_.step()) mark(face_), mark(ring);
        face_ = -1;
        const float rise = cell.height - ground_->height, run = std::max(cell.range - ground_->range, 0.01f);
        const bool steep = std::abs(rise) > near_.steepest() * run;
        if (steep && rise <= -near_.step()) {
            if (cell.range > ground_->range && cell.height <= -near_.step()) marks_.at(ring, column_) = kDrop;
            return false;
        }
        if (steep && rise >= near_.step()) mark(ring);
        if (steep && rise >= 0.5f * near_.step()) {  // half up a face: the next ring shows how high it is
            face_ = ring;
            below_ = ground_->height;
        }
        if (cell.range > ground_->range) ground_ = &cell;
        return true;
    }

    void mark(int ring) {
        const bool stands_out = near_.at(ring, column_).height >= 0.5f * near_.step();
        if (stands_out && !near_.isFoot(ring, column_)) marks_.at(ring, column_) = kRaised;
    }

    Marks& marks_;
    const NearGround& near_;
    int column_;
    const NearGround::Cell* ground_ = nullptr;  ///< the last that was seen
    int face_ = -1;                             ///< ring that may have met the face of a step
    float below_ = 0.0f;                        ///< height before it
};

/// Steps from ring to ring: steeper than ground can be.
void lookOutwards(Marks& marks) {
    for (int column = 0; column < marks.near.columns(); ++column) Outwards(marks, column).walk();
}

/// Range of the last ground before a cell, seen by the rings below it; where the beam itself passed the ground at the
/// latest.
float groundBefore(const NearGround& near, int ring, int column) {
    const NearGround::Cell& cell = near.at(ring, column);
    const float latest = cell.isReturn() ? near.crossing(cell) : near.expectedRange(ring, column);
    for (int r = ring - 1; r >= 0; --r) {
        const NearGround::Cell& below = near.at(r, column);
        if (below.isReturn() && near.isLevel(below) && below.height > -near.step() && below.range < latest)
            return below.range;
    }
    return latest;
}

/// Of the beams of a ring that should meet the ground nearby: the share that came back.
float shareOfReturns(const NearGround& near, int ring) {
    int expected = 0, returned = 0;
    for (int column = 0; column < near.columns(); ++column) {
        if (near.expectedRange(ring, column) > near.reach()) continue;
        ++expected;
        returned += static_cast<int>(near.at(ring, column).isReturn());
    }
    return expected == 0 ? 0.0f : static_cast<float>(returned) / static_cast<float>(expected);
}

/// Does the sensor look there: did a ring above the hole return something?
bool isLookedAt(const NearGround& near, int ring, int column) {
    const bool below = ring > 0 && near.at(ring - 1, column).isReturn();
    return below || (ring == 0 && near.rings() > 1 && near.at(1, column).isReturn());
}

bool isMissing(const NearGround& near, int ring, int column) {
    return !near.at(ring, column).isReturn() && near.expectedRange(ring, column) <= near.reach() &&
           isLookedAt(near, ring, column);
}

/// Beams side by side that should meet ground nearby and come back from nowhere.
std::vector<LowRun> holesOf(const NearGround& near, int ring) {
    return runsAround(
        near.columns(), [&](int column) { return isMissing(near, ring, column); },
        [](int last, int next) { return next == last + 1; });
}

void addHoles(const NearGround& near, int ring, std::vector<LowMark>& found) {
    constexpr float kLeastShare = 0.5f;
    constexpr float kNarrowest = 0.4f;  // [m]
    if (shareOfReturns(near, ring) < kLeastShare) return;
    for (const LowRun& hole : holesOf(near, ring)) {
        const int last = near.wrap(hole.last);
        const Eigen::Vector2f a = near.place(hole.first, near.expectedRange(ring, hole.first));
        const Eigen::Vector2f b = near.place(last, near.expectedRange(ring, last));
        if ((a - b).norm() < kNarrowest) continue;
        for (int k = hole.first; k <= hole.last; ++k) {
            const int column = near.wrap(k);
            const float expected = near.expectedRange(ring, column);
            found.push_back({ring, column, LowKind::NoGround, groundBefore(near, ring, column), expected});
        }
    }
}

/// Without two more of its kind beside it on the ring: grass, rain.
bool isLonely(Marks& marks, int ring, int column) {
    constexpr int kBeside = 3;  // columns
    int alike = 0;
    for (int k = -kBeside; k <= kBeside; ++k)
        alike += static_cast<int>(marks.at(ring, marks.near.wrap(column + k)) == marks.at(ring, column));
    return alike < 3;
}

}  // namespace

std::vector<LowMark> lowMarks(const NearGround& near) {
    Marks marks(near);
    lookAlongRings(marks);
    lookOutwards(marks);
    std::vector<LowMark> found;
    for (int ring = 0; ring < near.rings(); ++ring) {
        for (int column = 0; column < near.columns(); ++column) {
            const std::uint8_t mark = marks.at(ring, column);
            if (mark == kNoMark || isLonely(marks, ring, column)) continue;
            const float range = near.at(ring, column).range;
            if (mark == kRaised)
                found.push_back({ring, column, LowKind::Raised, range, range});
            else
                found.push_back({ring, column, LowKind::Drop, groundBefore(near, ring, column), range});
        }
        addHoles(near, ring, found);
    }
    return found;
}

}  // namespace lidar_obstacles
