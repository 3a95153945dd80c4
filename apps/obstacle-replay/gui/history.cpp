// SPDX-License-Identifier: BSD-3-Clause
#include "history.h"

#include <algorithm>

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
        case MarkKind::NewTrack:
            break;
    }
    return "new track";
}

void History::add(const DetectionResult& result, double time, const std::vector<int>& phantoms) {
    const bool ground = result.ground.evidence != GroundEvidence::None;
    if (had_ground_ && !ground) note(MarkKind::GroundLost, scans_, "no ground");
    had_ground_ = ground;
    const double gap = time - last_time_;
    if (scans_ > 0 && usual_gap_ > 0.0 && gap > 1.5 * usual_gap_)
        note(MarkKind::LateScan, scans_, std::to_string(static_cast<int>(1e3 * gap)) + " ms after the one before");
    if (scans_ > 0 && gap > 0.0) usual_gap_ = usual_gap_ > 0.0 ? std::min(usual_gap_ * 1.01, gap) : gap;
    last_time_ = time;
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
    notePhantoms(result, phantoms);
    ++scans_;
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
