// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/worst_scans.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace lidar_obstacles::evaluation {
namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kNotable = 0.2;  ///< badness of an object that is worth a line

double badness(const ObjectRecord& r) {
    if (!r.errors) return 1.0;
    const double face = std::abs(r.errors->face) / 2.0;
    const double heading = r.errors->heading_valid ? kDegrees * std::abs(r.errors->heading_180) / 45.0 : 0.0;
    return std::min(0.9, std::max(face, heading));
}

std::string reason(const ObjectRecord& r) {
    char text[200];
    const TruthObject& o = r.object;
    int n = std::snprintf(text, sizeof text, "%.20s %.40s, %.1f m away, %d returns", o.type.c_str(),
                          o.object_id.c_str(), o.range, o.num_points);
    std::string line(text, static_cast<std::size_t>(n));
    if (o.occluded > 0.0) {
        n = std::snprintf(text, sizeof text, ", occlusion %.2g", o.occluded);
        line.append(text, static_cast<std::size_t>(n));
    }
    if (!r.errors) return line + ": not found";
    n = std::snprintf(text, sizeof text, ": distance off by %+.2f m", r.errors->face);
    line.append(text, static_cast<std::size_t>(n));
    if (!r.errors->heading_valid) return line + ", no heading";
    n = std::snprintf(text, sizeof text, ", heading by %+.1f deg%s", kDegrees * r.errors->heading_180,
                      r.errors->swapped ? " (length and width exchanged)" : "");
    return line.append(text, static_cast<std::size_t>(n));
}

WorstScan rate(std::size_t set, std::vector<const ObjectRecord*> records) {
    std::stable_sort(records.begin(), records.end(),
                     [](const ObjectRecord* a, const ObjectRecord* b) { return badness(*a) > badness(*b); });
    WorstScan scan;
    scan.set = set;
    scan.scan_index = records.front()->object.scan_index;
    scan.timestamp = records.front()->timestamp;
    scan.worst = records.front();
    for (const ObjectRecord* r : records) {
        scan.badness += badness(*r);
        if (badness(*r) >= kNotable) scan.reasons.push_back(reason(*r));
    }
    return scan;
}

std::vector<WorstScan> rateAll(const std::vector<SetResult>& sets) {
    std::vector<WorstScan> scans;
    for (std::size_t s = 0; s < sets.size(); ++s) {
        std::map<double, std::vector<const ObjectRecord*>> by_time;
        for (const ObjectRecord& r : sets[s].records) {
            const bool wanted = sets[s].target_id.empty() || r.object.object_id == sets[s].target_id;
            if (r.counted && wanted) by_time[r.timestamp].push_back(&r);
        }
        for (auto& [time, records] : by_time) scans.push_back(rate(s, std::move(records)));
    }
    std::stable_sort(scans.begin(), scans.end(),
                     [](const WorstScan& a, const WorstScan& b) { return a.badness > b.badness; });
    return scans;
}

bool isSameEvent(const WorstScan& a, const WorstScan& b) {
    constexpr double kEvent = 2.0;  // [s]
    return a.set == b.set && a.worst->object.object_id == b.worst->object.object_id &&
           std::abs(a.timestamp - b.timestamp) < kEvent;
}

}  // namespace

std::vector<WorstScan> worstScans(const std::vector<SetResult>& sets, std::size_t count) {
    std::vector<WorstScan> chosen;
    std::vector<WorstScan> alike;
    for (WorstScan& scan : rateAll(sets)) {
        if (chosen.size() == count || scan.reasons.empty()) break;
        const bool seen =
            std::any_of(chosen.begin(), chosen.end(), [&](const WorstScan& other) { return isSameEvent(scan, other); });
        (seen ? alike : chosen).push_back(std::move(scan));
    }
    const auto more = static_cast<std::ptrdiff_t>(std::min(count - chosen.size(), alike.size()));
    chosen.insert(chosen.end(), alike.begin(), alike.begin() + more);
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const WorstScan& a, const WorstScan& b) { return a.badness > b.badness; });
    return chosen;
}

}  // namespace lidar_obstacles::evaluation
