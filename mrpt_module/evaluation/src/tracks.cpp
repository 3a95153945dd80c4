// SPDX-License-Identifier: BSD-3-Clause
#include "tracks.h"

#include <set>

namespace lidar_obstacles::evaluation {
namespace {

/// What was told of one object, scan by scan.
struct History {
    std::string last_id;
    bool seen = false;
    bool gap = false;  ///< seen before and lost since
};

/// Whether the detector keeps ids: one of them matched objects in two scans.
bool keepsIds(const SetResult& set) {
    std::map<std::string, std::set<double>> scans_of_id;
    for (const ObjectRecord& r : set.records) {
        if (!r.detection || r.detection->id.empty() || r.detection->id == "-1") continue;
        auto& scans = scans_of_id[r.detection->id];
        scans.insert(r.timestamp);
        if (scans.size() > 1) return true;
    }
    return false;
}

}  // namespace

void addTracks(const SetResult& set, TrackMetrics& tracks) {
    std::map<std::string, History> histories;
    std::size_t switches = 0;
    for (const ObjectRecord& r : set.records) {
        if (!r.counted) continue;
        History& h = histories[r.object.object_id];
        if (!r.detection) {
            h.gap = h.seen;
            continue;
        }
        if (h.seen && h.gap) ++tracks.fragmentations;
        if (h.seen && h.last_id != r.detection->id) ++switches;
        h = {r.detection->id, true, false};
    }
    for (const auto& [id, h] : histories) tracks.objects += h.seen ? 1 : 0;
    if (keepsIds(set)) tracks.id_switches = tracks.id_switches.value_or(0) + switches;
}

}  // namespace lidar_obstacles::evaluation
