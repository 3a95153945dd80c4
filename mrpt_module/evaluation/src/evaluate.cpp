// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/evaluate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "asked.h"
#include "lidar_obstacles/evaluation/box_overlap.h"
#include "scan_table.h"
#include "tracking_judge.h"

namespace lidar_obstacles::evaluation {
namespace {

/// The object that the target's word stands for: the one with most rows. @throws std::runtime_error if there is none.
std::string targetId(const LabelledSet& set, const EvaluationOptions& options) {
    std::vector<std::pair<std::string, std::size_t>> rows;  // in order of appearance: the first of equals is taken
    const bool by_id = options.target.rfind("id:", 0) == 0;
    for (const TruthObject& o : set.truth) {
        const bool is_type = o.type == options.target || toString(o.group) == options.target;
        const bool usable = o.num_points >= options.min_points && o.range <= options.max_range;
        if (by_id ? o.object_id != options.target.substr(3) : !(is_type && usable)) continue;
        auto it = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.first == o.object_id; });
        if (it == rows.end()) it = rows.insert(rows.end(), {o.object_id, 0});
        ++it->second;
    }
    if (rows.empty()) throw std::runtime_error(set.name + ": no object fits the target '" + options.target + "'");
    return std::max_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

class SetEvaluation {
  public:
    SetEvaluation(const LabelledSet& set, const EvaluationOptions& options) : set_(set), options_(options) {
        for (const EgoPose& p : set.ego) ego_of_scan_[p.scan_index] = &p;
        const std::vector<Eigen::Vector2d> velocities = egoVelocities(set.ego);
        for (std::size_t k = 0; k < velocities.size(); ++k)
            if (velocities[k].allFinite()) ego_velocity_[set.ego[k].scan_index] = velocities[k];
    }

    SetResult run() {
        const ScanTable table = tabulateScans(set_, options_);
        result_.name = set_.name;
        result_.detections_without_scan = table.lost;
        if (!options_.target.empty()) result_.target_id = targetId(set_, options_);
        for (const Scan& scan : table.scans) evaluateScan(scan);
        result_.scans = table.scans.size();
        result_.tracking = judgeTracking(set_.name, table.scans, options_);
        return std::move(result_);
    }

  private:
    void evaluateScan(const Scan& scan) {
        std::vector<TruthObject> objects;
        std::vector<Detection> detections;
        std::copy_if(scan.objects.begin(), scan.objects.end(), std::back_inserter(objects),
                     [](const TruthObject& o) { return o.num_points >= 1; });
        std::copy_if(
            scan.detections.begin(), scan.detections.end(), std::back_inserter(detections),
            [&](const Detection& d) { return isClaim(d, options_) && d.range <= options_.max_range + kBeyondRange; });
        std::vector<const Detection*> found(objects.size(), nullptr);
        std::vector<bool> used(detections.size(), false);
        for (const auto& [i, j] : matchBoxes(objects, detections, options_.match)) {
            found[i] = &detections[j];
            used[j] = true;
        }
        for (std::size_t i = 0; i < objects.size(); ++i) record(scan, objects[i], found[i]);
        for (std::size_t j = 0; j < detections.size(); ++j) {
            const Detection& d = detections[j];
            if (d.range > options_.max_range || !isInRegion(d.box, options_)) continue;
            ++result_.detections;
            if (!used[j]) result_.unmatched.push_back({scan.scan_index, causeOf(d, scan), d});
        }
    }

    void record(const Scan& scan, const TruthObject& object, const Detection* found) {
        if (object.group == Group::Other || options_.ignore.count(object.type) != 0) return;
        ObjectRecord r;
        r.object = object;
        r.timestamp = scan.timestamp;
        r.counted = isAskedFor(object, options_);
        const auto velocity = ego_velocity_.find(scan.scan_index);
        if (velocity != ego_velocity_.end()) r.ego_velocity = velocity->second;
        if (found != nullptr) {
            r.detection = *found;
            r.errors = boxErrors(object, *found);
        }
        result_.records.push_back(std::move(r));
    }

    std::string causeOf(const Detection& d, const Scan& scan) const {
        constexpr double kLabelMargin = 0.3;  // [m]
        const double area = std::max(1e-9, d.box.size.x() * d.box.size.y());
        bool on_object = false;
        for (const TruthObject& o : scan.objects) {
            const double shared = sharedArea(grown(o.box, kLabelMargin), d.box);
            const bool ignored = o.group == Group::Other || options_.ignore.count(o.type) != 0;
            if (ignored && shared > 0.0) return "ignored";
            if (shared > 0.3 * area) on_object = true;
        }
        return on_object ? "fragment" : causeAmongStatics(d, scan);
    }

    std::string causeAmongStatics(const Detection& d, const Scan& scan) const {
        const auto ego = ego_of_scan_.find(scan.scan_index);
        if (set_.statics.empty() || ego == ego_of_scan_.end()) return "phantom";
        constexpr double kLongest = 12.0;      // [m] a box whose centre is farther may still reach into the region
        constexpr double kStaticMargin = 0.4;  // [m]
        const double area = std::max(1e-9, d.box.size.x() * d.box.size.y());
        std::string cause = "phantom";
        for (const StaticBox& s : staticBoxesNear(set_.statics, *ego->second, options_.max_range + kLongest)) {
            if (sharedArea(grown(s.box, kStaticMargin), d.box) <= 0.15 * area) continue;
            if (s.type != "overhead") return "structure";
            cause = "overhead";
        }
        return cause;
    }

    const LabelledSet& set_;
    const EvaluationOptions& options_;
    std::map<int, const EgoPose*> ego_of_scan_;
    std::map<int, Eigen::Vector2d> ego_velocity_;
    SetResult result_;
};

}  // namespace

BoxErrors boxErrors(const TruthObject& object, const Detection& detection) {
    const OrientedBox& g = object.box;
    const OrientedBox& d = detection.box;
    BoxErrors e;
    e.face = detection.range - object.range;
    e.centre = (d.center - g.center).head<2>().norm();
    e.dz = d.center.z() - g.center.z();
    e.bev_iou = bevIou(g, d);
    e.iou_3d = iou3d(g, d);
    e.heading_valid = detection.heading_valid;
    e.heading_180 = wrapAngle(d.yaw - g.yaw, M_PI);
    e.heading_90 = wrapAngle(d.yaw - g.yaw, 0.5 * M_PI);
    e.swapped = std::abs(e.heading_180) > 0.25 * M_PI;
    e.flipped = std::abs(wrapAngle(d.yaw - g.yaw, 2.0 * M_PI)) >= 0.5 * M_PI;
    e.length = (e.swapped ? d.size.y() : d.size.x()) - g.size.x();
    e.width = (e.swapped ? d.size.x() : d.size.y()) - g.size.y();
    e.height = d.size.z() - g.size.z();
    const double velocity = detection.track.velocity.x() - object.velocity.x();
    if (std::isfinite(velocity)) e.velocity = velocity;
    return e;
}

SetResult evaluateSet(const LabelledSet& set, const EvaluationOptions& options) {
    return SetEvaluation(set, options).run();
}

}  // namespace lidar_obstacles::evaluation
