// SPDX-License-Identifier: BSD-3-Clause
#include "tracking_json.h"

#include <algorithm>

#include "common/number_text.h"
#include "lidar_obstacles/evaluation/metrics.h"
#include "metrics_json.h"

namespace lidar_obstacles::apps {
namespace {

using evaluation::TrackingResult;
using Json = nlohmann::ordered_json;

Json orNull(const std::optional<double>& value) { return value ? Json(rounded(*value)) : Json(); }

/// Median and 95th percentile; `errors` are not negative.
Json quantilesJson(const std::vector<double>& errors, bool with_count) {
    const evaluation::ErrorStatistics s = evaluation::statisticsOf(errors);
    Json json = Json::object();
    if (with_count) json["n"] = s.count;
    json["median"] = s.count > 0 ? Json(rounded(s.median_abs)) : Json();
    json["p95"] = s.count > 0 ? Json(rounded(s.p95_abs)) : Json();
    return json;
}

Json perScan(const std::map<std::string, std::size_t>& counts, std::size_t scans) {
    Json json = Json::object();
    for (const auto& [name, n] : counts)
        json[name] = rounded(static_cast<double>(n) / static_cast<double>(std::max<std::size_t>(scans, 1)));
    return json;
}

Json blindJson(const evaluation::BlindCounts& b) {
    constexpr std::size_t kListed = 5;
    Json json = {{"asked", b.asked},
                 {"blind_scans", b.blind},
                 {"share", rounded(b.share())},
                 {"longest_run", b.longestRun()},
                 {"objects_3_or_more", b.objectsBlindFor(3)}};
    json["worst"] = Json::array();
    for (std::size_t k = 0; k < std::min(kListed, b.runs.size()); ++k)
        json["worst"].push_back({{"set", b.runs[k].set}, {"object", b.runs[k].object_id}, {"scans", b.runs[k].scans}});
    return json;
}

Json velocityJson(const evaluation::VelocityCounts& v) {
    const auto asked = static_cast<double>(std::max<std::size_t>(v.asked, 1));
    Json json = {{"told", rounded(static_cast<double>(v.told) / asked)},
                 {"moving", quantilesJson(v.moving, true)},
                 {"standing", quantilesJson(v.standing, true)},
                 {"ghost", orNull(v.ghosts())},
                 {"standing_told_moving", orNull(evaluation::shareOf(v.standing_called))},
                 {"moving_told_moving", orNull(evaluation::shareOf(v.moving_called))}};
    Json& heading = json["heading360"] = quantilesJson(v.heading_360_deg, true);
    heading["of"] = v.headings_asked;
    heading["reversed"] = orNull(v.reversed());
    return json;
}

void addTracks(const evaluation::GroupTracking& g, Json& json) {
    const auto objects = static_cast<double>(std::max<std::size_t>(g.clear.objects, 1));
    json["hota"] = rounded(g.hota.hota());
    json["deta"] = rounded(g.hota.detection());
    json["assa"] = rounded(g.hota.associationAccuracy());
    json["mota"] = rounded(g.clear.mota());
    json["idsw"] = g.clear.id_switches;
    json["frag"] = g.clear.fragmentations;
    json["objects"] = g.clear.objects;
    json["mostly_tracked"] = rounded(static_cast<double>(g.clear.mostly_tracked) / objects);
    json["misses"] = g.clear.missed;
    json["false"] = g.clear.invented;
    json["velocity"] = velocityJson(g.velocity);
    json["jitter"] = {{"yaw_deg", quantilesJson(g.jitter.yaw_deg, false)},
                      {"length_m", quantilesJson(g.jitter.length, false)}};
}

}  // namespace

void addTracking(const TrackingResult& result, Json& json) {
    json["boxes_per_scan"] = perScan(result.boxes, result.scans);
    json["blind"] = blindJson(result.blind);
    if (!result.repeated_id.empty()) json["tracks_missing"] = result.repeated_id;
    Json& by_class = json["by_class"] = Json::object();
    for (const auto& [group, g] : result.groups) {
        Json& of_group = by_class[toString(group)] = {{"gt", g.classes.asked},
                                                      {"precision", rounded(g.classes.precision())},
                                                      {"recall", rounded(g.classes.recall())},
                                                      {"f1", rounded(g.classes.f1())},
                                                      {"ap", orNull(g.classes.averagePrecision())},
                                                      {"ece", orNull(g.classes.calibrationError())},
                                                      {"false_per_scan", perScan(g.classes.wrong, result.scans)}};
        if (result.repeated_id.empty()) addTracks(g, of_group);
    }
}

}  // namespace lidar_obstacles::apps
