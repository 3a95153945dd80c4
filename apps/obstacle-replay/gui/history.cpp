// SPDX-License-Identifier: BSD-3-Clause
#include "history.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

constexpr double kSamePlace = 0.5;  ///< [m]

HistoryPoint pointOf(const Obstacle& o, double time, std::size_t scan) {
    HistoryPoint p;
    p.time = time;
    p.center = o.box.center.head<2>().cast<float>();
    p.distance = static_cast<float>(distanceTo(o.box));
    p.size = o.box.size.cast<float>();
    if (o.track && o.track->velocity) p.speed = o.track->moving ? static_cast<float>(o.track->velocity->norm()) : 0.F;
    p.classes = o.probability;
    p.scan = scan;
    return p;
}

std::string milliseconds(double time) { return std::to_string(std::lround(1e3 * time)) + " ms"; }

/// Ends may be beyond pi.
bool meet(const AzimuthSpan& a, const AzimuthSpan& b) {
    for (const double turn : {-2.0 * M_PI, 0.0, 2.0 * M_PI})
        if (a.from < b.to + turn && b.from + turn < a.to) return true;
    return false;
}

/// What is wrong and was not before. A blocked sector that grows is the same one.
HealthReport begunSince(const HealthReport& before, const HealthReport& now) {
    HealthReport begun = now;
    const auto was_blocked = [&](const AzimuthSpan& s) {
        return std::any_of(before.blocked.begin(), before.blocked.end(), [&](const auto& b) { return meet(s, b); });
    };
    begun.blocked.erase(std::remove_if(begun.blocked.begin(), begun.blocked.end(), was_blocked), begun.blocked.end());
    begun.silent_rings.clear();
    std::set_difference(now.silent_rings.begin(), now.silent_rings.end(), before.silent_rings.begin(),
                        before.silent_rings.end(), std::back_inserter(begun.silent_rings));
    begun.turned = now.turned && !before.turned;
    begun.wrong_rate = now.wrong_rate && !before.wrong_rate;
    begun.poses_lost = now.poses_lost && !before.poses_lost;
    return begun;
}

}  // namespace

const char* toString(MarkKind kind) {
    switch (kind) {
        case MarkKind::LostTrack:
            return "lost track";
        case MarkKind::GroundLost:
            return "ground lost";
        case MarkKind::LateScan:
            return "late scan";
        case MarkKind::Phantom:
            return "phantom";
        case MarkKind::Fault:
            return "sensor fault";
        case MarkKind::SlowScan:
            return "slow scan";
        case MarkKind::NewTrack:
            break;
    }
    return "new track";
}

void History::add(const DetectionResult& result, double time, const ScanNotes& notes) {
    const bool ground = result.ground.evidence != GroundEvidence::None;
    if (had_ground_ && !ground) note(MarkKind::GroundLost, scans_, "no ground");
    had_ground_ = ground;
    noteTime(time, notes.took);
    noteFaults(notes.health);
    std::vector<int> ids;
    for (const Obstacle& o : result.obstacles) {
        if (o.cls == ObstacleClass::Structure || o.id >= kFirstUntrackedId) continue;
        points_[o.id].push_back(pointOf(o, time, scans_));
        ids.push_back(o.id);
    }
    if (seconds_ > 0.0)
        forget(time - seconds_);
    else
        ids_.push_back(std::move(ids));
    noteTracks(result);
    notePhantoms(result, notes.phantoms);
    ++scans_;
}

void History::noteTime(double time, double took) {
    const double gap = time - last_time_;
    if (scans_ > 0 && usual_gap_ > 0.0 && gap > 1.5 * usual_gap_)
        note(MarkKind::LateScan, scans_, milliseconds(gap) + " after the one before");
    if (scans_ > 0 && gap > 0.0) usual_gap_ = usual_gap_ > 0.0 ? std::min(usual_gap_ * 1.01, gap) : gap;
    last_time_ = time;
    const bool is_slow = usual_gap_ > 0.0 && took > usual_gap_;
    if (is_slow && !was_slow_)
        note(MarkKind::SlowScan, scans_,
             "it took " + milliseconds(took) + ", and scans come every " + milliseconds(usual_gap_));
    was_slow_ = is_slow;
}

void History::noteFaults(const HealthReport& health) {
    const HealthReport begun = begunSince(health_, health);
    if (!begun.ok()) note(MarkKind::Fault, scans_, toText(begun));
    health_ = health;
}

void History::notePhantoms(const DetectionResult& result, const std::vector<int>& phantoms) {
    for (const Obstacle& o : result.obstacles) {
        const auto is_in = [&](const std::vector<int>& all) {
            return std::find(all.begin(), all.end(), o.id) != all.end();
        };
        if (is_in(phantoms) && !is_in(phantoms_))
            note(MarkKind::Phantom, scans_,
                 std::string(toString(o.cls)) + " " + std::to_string(o.id) + " where the truth has nothing");
    }
    phantoms_ = phantoms;
}

void History::noteTracks(const DetectionResult& result) {
    for (const Obstacle& o : result.obstacles) {
        if (!o.track || o.cls == ObstacleClass::Structure) continue;
        Followed& f = followed_[o.id];
        f.last = scans_;
        f.name = std::string(toString(o.cls)) + " " + std::to_string(o.id);
        if (f.told || !(o.track->age > 0.0)) continue;
        f.told = true;
        if (scans_ > 1) note(MarkKind::NewTrack, scans_, f.name + " is new");
    }
    for (auto f = followed_.begin(); f != followed_.end();) {
        const bool lost = f->second.last < scans_;
        if (lost && f->second.told) note(MarkKind::LostTrack, f->second.last, f->second.name + " is lost");
        f = lost ? followed_.erase(f) : std::next(f);
    }
}

/// Marks stay in the order of their scans: a track is lost in the scan before the one that tells it.
void History::note(MarkKind kind, std::size_t scan, const std::string& text) {
    const auto after =
        std::upper_bound(marks_.begin(), marks_.end(), scan, [](std::size_t s, const Mark& m) { return s < m.scan; });
    marks_.insert(after, {scan, kind, text});
}

void History::forget(double before) {
    for (auto p = points_.begin(); p != points_.end();) {
        auto& points = p->second;
        const auto first = std::find_if(points.begin(), points.end(), [&](const auto& q) { return q.time >= before; });
        points.erase(points.begin(), first);
        p = points.empty() ? points_.erase(p) : std::next(p);
    }
    if (marks_.size() > 1000) marks_.erase(marks_.begin(), marks_.begin() + 500);
}

const std::vector<HistoryPoint>& History::of(int id) const {
    static const std::vector<HistoryPoint> kNone;
    const auto known = points_.find(id);
    return known == points_.end() ? kNone : known->second;
}

std::optional<int> History::at(std::size_t scan, const Eigen::Vector2d& center) const {
    if (scan >= ids_.size()) return std::nullopt;
    std::optional<int> nearest;
    float least = kSamePlace;
    for (const int id : ids_[scan]) {
        const auto& points = of(id);
        const auto p = std::lower_bound(points.begin(), points.end(), scan,
                                        [](const HistoryPoint& q, std::size_t s) { return q.scan < s; });
        if (p == points.end() || p->scan != scan) continue;
        const float away = (p->center - center.cast<float>()).norm();
        if (away >= least) continue;
        least = away;
        nearest = id;
    }
    return nearest;
}

std::optional<std::size_t> nextMark(const std::vector<Mark>& marks, std::size_t scan, int direction) {
    if (direction > 0) {
        for (const Mark& m : marks)
            if (m.scan > scan) return m.scan;
    } else {
        for (auto m = marks.rbegin(); m != marks.rend(); ++m)
            if (m->scan < scan) return m->scan;
    }
    return std::nullopt;
}

}  // namespace lidar_obstacles::apps
