// SPDX-License-Identifier: BSD-3-Clause
#include "tracking_judge.h"

#include <algorithm>
#include <set>

#include "asked.h"
#include "lidar_obstacles/evaluation/box_overlap.h"

namespace lidar_obstacles::evaluation {
namespace {

JudgedScans judgedScans(const std::vector<Scan>& scans, const EvaluationOptions& options) {
    JudgedScans judged = scans;
    for (Scan& scan : judged) {
        for (TruthObject& o : scan.objects)
            if (options.ignore.count(o.type) != 0) o.group = Group::Other;
    }
    return judged;
}

/// The first id that a scan has twice, in words; "" where ids are unique within each scan.
std::string repeatedId(const std::vector<Scan>& scans) {
    for (const Scan& scan : scans) {
        std::set<std::string> ids;
        for (const Detection& d : scan.detections) {
            if (!ids.insert(d.id).second)
                return "id '" + d.id + "' twice in scan " + std::to_string(d.scan_index) + " at " +
                       std::to_string(scan.timestamp) + " s";
        }
    }
    return "";
}

/// Whether a box that fits no object of its group stands on one that is neither wanted nor false.
bool standsOnOther(const Detection& d, const Scan& scan, JudgedGroup group, const EvaluationOptions& options) {
    constexpr double kLabelMargin = 0.3;  // [m]
    const double enough = 0.3 * d.box.size.x() * d.box.size.y();
    return std::any_of(scan.objects.begin(), scan.objects.end(), [&](const TruthObject& o) {
        if (isAskedFor(o, options) && o.group != Group::Other) return false;
        return fitOf(o, d, group) > 0.0 || sharedArea(grown(o.box, kLabelMargin), d.box) > enough;
    });
}

TrackedScan trackedScan(const Scan& scan, JudgedGroup group, const EvaluationOptions& options) {
    TrackedScan tracked;
    tracked.timestamp = scan.timestamp;
    for (const TruthObject& o : scan.objects)
        if (belongsTo(o.group, group) && isAskedFor(o, options)) tracked.objects.push_back(&o);
    for (const Detection& d : scan.detections) {
        if (!isBoxOf(d, group, options)) continue;
        const bool on_object = std::any_of(tracked.objects.begin(), tracked.objects.end(),
                                           [&](const TruthObject* o) { return fitOf(*o, d, group) > 0.0; });
        const bool claims_nothing = d.range > options.max_range || d.track.seen == 0.0;
        if (on_object || (!claims_nothing && !standsOnOther(d, scan, group, options))) tracked.boxes.push_back(&d);
    }
    return tracked;
}

bool isAskedAtAll(const JudgedScans& scans, JudgedGroup group, const EvaluationOptions& options) {
    return std::any_of(scans.begin(), scans.end(), [&](const Scan& scan) {
        return std::any_of(scan.objects.begin(), scan.objects.end(),
                           [&](const TruthObject& o) { return belongsTo(o.group, group) && isAskedFor(o, options); });
    });
}

void judgeTracks(const JudgedScans& scans, JudgedGroup group, const EvaluationOptions& options, GroupTracking& result) {
    std::vector<TrackedScan> tracked;
    tracked.reserve(scans.size());
    for (const Scan& scan : scans) tracked.push_back(trackedScan(scan, group, options));
    std::vector<TrackedPair> pairs;
    result.hota = countHota(tracked, group);
    result.clear = countClear(tracked, group, pairs);
    result.velocity = countVelocities(pairs);
    result.jitter = countJitter(pairs);
}

}  // namespace

double fitOf(const TruthObject& o, const Detection& d, JudgedGroup group) {
    constexpr double kMargin = 0.2;  // [m]
    const double gate = group == JudgedGroup::Vehicle ? 2.0 : 1.0;
    const double apart = (o.box.center - d.box.center).head<2>().norm();
    if (!(apart <= gate + 0.5 * o.box.size.head<2>().norm())) return 0.0;
    const double iou = bevIou(o.box, d.box);
    if (apart > gate && iou < 0.3) return 0.0;
    const double smaller = std::min(std::max(1e-9, d.box.size.x() * d.box.size.y()), o.box.size.x() * o.box.size.y());
    if (sharedArea(grown(o.box, kMargin), d.box) < 0.2 * smaller) return 0.0;  // beside it is not on it
    return 1e-3 + iou + (apart <= gate ? 0.5 * (1.0 - apart / gate) : 0.0);
}

bool isBoxOf(const Detection& d, JudgedGroup group, const EvaluationOptions& options) {
    return belongsTo(d.group, group) && d.range <= options.max_range + kBeyondRange && isInRegion(d.box, options);
}

TrackingResult judgeTracking(const std::string& name, const std::vector<Scan>& scans,
                             const EvaluationOptions& options) {
    const JudgedScans judged = judgedScans(scans, options);
    TrackingResult result;
    result.scans = judged.size();
    for (const Scan& scan : judged) {
        for (const Detection& d : scan.detections) result.boxes[d.cls] += d.range <= options.max_range ? 1 : 0;
    }
    result.blind = countBlind(name, judged, options);
    if (const std::string id = repeatedId(judged); !id.empty()) result.repeated_id = name + ": " + id;
    for (const JudgedGroup group : kJudgedGroups) {
        if (!isAskedAtAll(judged, group, options)) continue;
        GroupTracking& g = result.groups[group];
        g.classes = countClasses(judged, group, options);
        if (result.repeated_id.empty()) judgeTracks(judged, group, options, g);
    }
    return result;
}

}  // namespace lidar_obstacles::evaluation
