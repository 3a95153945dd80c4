// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "lidar_obstacles/evaluation/box_overlap.h"
#include "tracking_judge.h"

namespace lidar_obstacles::evaluation {
namespace {

constexpr double kDegrees = 180.0 / M_PI;

/// What was found of one object so far.
struct Found {
    std::string last_id;
    bool ever = false;
    bool lost = false;  ///< not found in the last scan
    std::size_t found = 0;
    std::size_t asked = 0;
};

class ClearMot {
  public:
    ClearMot(JudgedGroup group, std::vector<TrackedPair>& pairs) : group_(group), pairs_(pairs) {}

    void add(const TrackedScan& scan) {
        std::vector<const Detection*> box_of(scan.objects.size(), nullptr);
        const IndexPairs matched = pairsOfLargestScore(scores(scan));
        for (const auto& [i, j] : matched) box_of[i] = scan.boxes[j];
        counts_.invented += scan.boxes.size() - matched.size();
        for (std::size_t i = 0; i < scan.objects.size(); ++i) add(scan.timestamp, *scan.objects[i], box_of[i]);
    }

    ClearCounts counts() const {
        ClearCounts c = counts_;
        c.objects = objects_.size();
        for (const auto& [id, o] : objects_)
            c.mostly_tracked += static_cast<double>(o.found) >= 0.8 * static_cast<double>(o.asked) ? 1 : 0;
        return c;
    }

  private:
    /// What was matched before stays matched wherever it may.
    Eigen::MatrixXd scores(const TrackedScan& scan) const {
        constexpr double kStays = 10.0;
        Eigen::MatrixXd scores(static_cast<Eigen::Index>(scan.objects.size()),
                               static_cast<Eigen::Index>(scan.boxes.size()));
        for (Eigen::Index i = 0; i < scores.rows(); ++i) {
            const TruthObject& o = *scan.objects[static_cast<std::size_t>(i)];
            const auto before = objects_.find(o.object_id);
            for (Eigen::Index j = 0; j < scores.cols(); ++j) {
                const Detection& d = *scan.boxes[static_cast<std::size_t>(j)];
                const double fit = fitOf(o, d, group_);
                const bool same = before != objects_.end() && before->second.ever && before->second.last_id == d.id;
                scores(i, j) = fit + (same && fit > 0.0 ? kStays : 0.0);
            }
        }
        return scores;
    }

    void add(double timestamp, const TruthObject& object, const Detection* box) {
        Found& o = objects_[object.object_id];
        ++o.asked;
        if (box == nullptr) {
            ++counts_.missed;
            o.lost = true;
            return;
        }
        ++counts_.found;
        ++o.found;
        if (o.ever && o.last_id != box->id) ++counts_.id_switches;
        if (o.ever && o.lost) ++counts_.fragmentations;
        o.last_id = box->id;
        o.ever = true;
        o.lost = false;
        pairs_.push_back({timestamp, &object, box});
    }

    JudgedGroup group_;
    std::vector<TrackedPair>& pairs_;
    ClearCounts counts_;
    std::map<std::string, Found> objects_;
};

constexpr double kMoving = 1.0;    // faster than this it moves [m/s]
constexpr double kStanding = 0.1;  // slower than this it stands [m/s]

void countVelocity(const TruthObject& o, const Detection& d, VelocityCounts& c) {
    const double speed = o.velocity.norm();
    const bool moves = speed > kMoving;
    const bool stands = speed < kStanding;
    ++c.asked;
    if (std::isfinite(d.track.moving)) {
        if (moves) c.moving_called.push_back(d.track.moving != 0.0);
        if (stands) c.standing_called.push_back(d.track.moving != 0.0);
    }
    if (moves) {
        ++c.headings_asked;
        if (d.heading_valid && d.track.direction_known == 1.0)
            c.heading_360_deg.push_back(std::abs(kDegrees * wrapAngle(d.box.yaw - o.box.yaw, 2.0 * M_PI)));
    }
    if (!std::isfinite(d.track.velocity.x())) return;
    ++c.told;
    if (moves) c.moving.push_back((d.track.velocity - o.velocity).norm());
    if (stands) c.standing.push_back(d.track.velocity.norm());
}

}  // namespace

ClearCounts countClear(const std::vector<TrackedScan>& scans, JudgedGroup group, std::vector<TrackedPair>& pairs) {
    ClearMot clear(group, pairs);
    for (const TrackedScan& scan : scans) clear.add(scan);
    return clear.counts();
}

double ClearCounts::mota() const {
    const double asked = static_cast<double>(std::max<std::size_t>(found + missed, 1));
    return 1.0 - static_cast<double>(missed + invented + id_switches) / asked;
}

VelocityCounts countVelocities(const std::vector<TrackedPair>& pairs) {
    constexpr double kSettled = 1.0;  // age of a track [s]
    VelocityCounts counts;
    for (const TrackedPair& p : pairs) {
        if (std::isfinite(p.object->velocity.x()) && !(p.box->track.age < kSettled))
            countVelocity(*p.object, *p.box, counts);
    }
    return counts;
}

JitterCounts countJitter(const std::vector<TrackedPair>& pairs) {
    constexpr double kGap = 0.6;  // scans farther apart are no neighbours [s]
    JitterCounts counts;
    std::map<std::string, TrackedPair> last;
    for (const TrackedPair& p : pairs) {
        if (!(p.object->velocity.norm() < kStanding)) continue;
        const auto [before, is_first] = last.try_emplace(p.object->object_id, p);
        const TrackedPair b = std::exchange(before->second, p);
        if (is_first || p.timestamp - b.timestamp > kGap) continue;
        const auto error = [](const TrackedPair& q) { return wrapAngle(q.box->box.yaw - q.object->box.yaw, M_PI); };
        if (p.box->heading_valid && b.box->heading_valid)
            counts.yaw_deg.push_back(std::abs(kDegrees * wrapAngle(error(p) - error(b), M_PI)));
        counts.length.push_back(std::abs(p.box->box.size.x() - b.box->box.size.x()));
    }
    return counts;
}

}  // namespace lidar_obstacles::evaluation
