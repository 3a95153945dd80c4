// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <tuple>

#include "asked.h"
#include "lidar_obstacles/evaluation/box_overlap.h"
#include "tracking_judge.h"

namespace lidar_obstacles::evaluation {
namespace {

/// Whether a box of any class lies on the object and, for its larger part, within a metre of it: a hedge's box is no
/// box of the person in it.
bool isOn(const TruthObject& o, const OrientedBox& box) {
    const double area = std::max(0.01, box.size.x() * box.size.y());
    const double reach = 0.5 * (box.size.head<2>().norm() + o.box.size.head<2>().norm()) + 1.0;
    if ((box.center - o.box.center).head<2>().norm() > reach) return false;
    const double smaller = std::min(area, o.box.size.x() * o.box.size.y());
    return sharedArea(grown(o.box, 0.3), box) > 0.2 * smaller && sharedArea(grown(o.box, 1.0), box) >= 0.5 * area;
}

/// An object's scans without a box.
struct Run {
    std::size_t now = 0;
    std::size_t longest = 0;

    void add(bool covered) {
        now = covered ? 0 : now + 1;
        longest = std::max(longest, now);
    }
};

bool isNear(const TruthObject& o, const EvaluationOptions& options) {
    return o.group != Group::Other && isAskedFor(o, options) && o.range <= options.near;
}

bool isCovered(const TruthObject& o, const std::vector<Detection>& boxes) {
    return std::any_of(boxes.begin(), boxes.end(), [&](const Detection& d) { return isOn(o, d.box); });
}

}  // namespace

BlindCounts countBlind(const std::string& set, const JudgedScans& scans, const EvaluationOptions& options) {
    BlindCounts counts;
    std::map<std::string, Run> runs;
    for (const Scan& scan : scans) {
        for (const TruthObject& o : scan.objects) {
            if (!isNear(o, options)) continue;
            const bool covered = isCovered(o, scan.detections);
            ++counts.asked;
            counts.blind += covered ? 0 : 1;
            runs[o.object_id].add(covered);
        }
    }
    for (const auto& [id, run] : runs)
        if (run.longest > 0) counts.runs.push_back({set, id, run.longest});
    std::sort(counts.runs.begin(), counts.runs.end(), isLonger);
    return counts;
}

}  // namespace lidar_obstacles::evaluation
