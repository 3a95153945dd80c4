// SPDX-License-Identifier: BSD-3-Clause
#include "metrics_json.h"

#include <cmath>

#include "tracking_json.h"

namespace lidar_obstacles::apps {
namespace {

using evaluation::ErrorStatistics;
using evaluation::GroupMetrics;
using evaluation::Metrics;
using Json = nlohmann::ordered_json;

Json statisticsJson(const ErrorStatistics& s) {
    if (s.count == 0) return {{"n", 0}};
    return {{"n", s.count},
            {"mean", rounded(s.mean)},
            {"mae", rounded(s.mean_abs)},
            {"median", rounded(s.median_abs)},
            {"p95", rounded(s.p95_abs)},
            {"rmse", rounded(s.rmse)}};
}

/// @param always  names that are there even if nothing was counted.
Json perScan(const std::map<std::string, std::size_t>& counts, std::size_t scans,
             const std::vector<const char*>& always) {
    Json json = Json::object();
    for (const char* name : always) json[name] = 0.0;
    for (const auto& [name, count] : counts)
        json[name] = rounded(static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(scans, 1)));
    return json;
}

Json intervalsJson(const evaluation::Intervals& intervals) {
    Json json = Json::object();
    for (const auto& [name, i] : intervals) json[name] = {rounded(i.low), rounded(i.high)};
    return json;
}

void addHeadingRates(const GroupMetrics& m, Json& json) {
    const bool any = m.heading_180.count > 0;
    const auto rate = [&](double value) { return any ? Json(rounded(value)) : Json(); };
    json["h180_over20"] = rate(m.over_20_deg);
    json["direction_ok"] = rate(1.0 - m.flip_rate);
    json["swap_rate"] = rate(m.swap_rate);
    json["flip_rate"] = rate(m.flip_rate);
}

const char* poseWord(evaluation::TruthPose pose) {
    switch (pose) {
        case evaluation::TruthPose::Reference:
            return "ref";
        case evaluation::TruthPose::MidScan:
            return "mid";
        case evaluation::TruthPose::EgoCorrected:
            return "ego";
        case evaluation::TruthPose::Observed:
            break;
    }
    return "obs";
}

}  // namespace

double rounded(double value) { return std::round(value * 1e6) / 1e6; }

Json toJson(const GroupMetrics& m) {
    Json json = {{"gt", m.asked}, {"hit", m.found}, {"objects", m.objects}};
    json["recall"] = m.asked > 0 ? Json(rounded(m.recall())) : Json();
    if (m.found > 0) {
        json["face_m"] = statisticsJson(m.face);
        json["centre_m"] = statisticsJson(m.centre);
        json["dz_m"] = statisticsJson(m.dz);
        json["heading_valid"] = rounded(m.heading_valid);
        json["h180_deg"] = statisticsJson(m.heading_180);
        json["h90_deg"] = statisticsJson(m.heading_90);
        addHeadingRates(m, json);
        json["iou"] = {{"mean", rounded(m.bev_iou_mean)}, {"median", rounded(m.bev_iou_median)}};
        json["iou3"] = {{"mean", rounded(m.iou_3d_mean)}, {"median", rounded(m.iou_3d_median)}};
        json["dl"] = statisticsJson(m.length);
        json["dw"] = statisticsJson(m.width);
        json["dh"] = statisticsJson(m.height);
        json["vx_mps"] = statisticsJson(m.velocity);
    }
    json["ci95"] = intervalsJson(m.intervals);
    return json;
}

Json toJson(const Metrics& m) {
    const auto scans = static_cast<double>(std::max<std::size_t>(m.scans, 1));
    Json json = {{"scans", m.scans},
                 {"detections_in_roi_per_scan", rounded(static_cast<double>(m.detections) / scans)},
                 {"detections_without_scan", m.detections_without_scan},
                 {"fp_per_scan", rounded(m.falsePerScan())},
                 {"unmatched_per_scan",
                  perScan(m.unmatched, m.scans, {"fragment", "ignored", "overhead", "phantom", "structure"})},
                 {"classified_on_nothing_per_scan", perScan(m.classified_on_nothing, m.scans, {})}};
    json["recall_by_type"] = Json::object();
    for (const auto& [type, n] : m.found_by_type)
        json["recall_by_type"][type] = {n.first, rounded(static_cast<double>(n.second) / static_cast<double>(n.first))};
    json["class_of_matched"] = m.class_of_matched;
    json["tracks"] = {{"objects_tracked", m.tracks.objects},
                      {"id_switches", m.tracks.id_switches ? Json(*m.tracks.id_switches) : Json()},
                      {"fragmentations", m.tracks.fragmentations}};
    for (const auto& [group, metrics] : m.groups) {
        Json& g = json[toString(group)] = toJson(metrics);
        g["bins"] = Json::object();
        if (m.bins.count(group) == 0) continue;
        for (const auto& [bin, in_bin] : m.bins.at(group))
            g["bins"][std::to_string(bin.from) + '-' + std::to_string(bin.to)] = toJson(in_bin);
    }
    if (m.target) json["target"] = toJson(*m.target);
    addTracking(m.tracking, json);
    return json;
}

Json optionsJson(const EvaluateOptions& o, const Variant& variant) {
    const evaluation::EvaluationOptions& e = o.evaluation;
    Json json;
    json["sets"] = Json::array();
    for (const SetFiles& s : o.sets) {
        Json files = {{"name", s.name}, {"truth", s.truth}};
        files[s.detections.empty() ? "rawlog" : "detections"] = s.detections.empty() ? s.rawlog : s.detections;
        json["sets"].push_back(std::move(files));
    }
    json["variant"] = variant.name;
    json["config"] = o.config.empty() ? "built-in defaults" : o.config;
    json["set"] = o.set;
    for (const std::string& assignment : variant.set) json["set"].push_back(assignment);
    json["gt_pose"] = poseWord(o.pose);
    json["min_points"] = e.min_points;
    json["max_range"] = e.max_range;
    json["near"] = e.near;
    json["fov"] = e.fov_deg;
    json["roi"] = e.roi ? Json({e.roi->x_min, e.roi->x_max, e.roi->y_min, e.roi->y_max}) : Json();
    json["target"] = e.target.empty() ? Json() : Json(e.target);
    json["bootstrap"] = {{"replicates", o.bootstrap.replicates}, {"seed", o.bootstrap.seed}};
    return json;
}

}  // namespace lidar_obstacles::apps
