// SPDX-License-Identifier: BSD-3-Clause
#include "summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lidar_obstacles/mrpt_bridge/config_file.h"

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::ordered_json;

void addTime(Summary& summary, const std::string& stage, double ms) {
    auto& timing = summary.timing;
    auto it = std::find_if(timing.begin(), timing.end(), [&](const auto& t) { return t.first == stage; });
    if (it == timing.end()) it = timing.insert(timing.end(), {stage, {}});
    it->second.push_back(static_cast<float>(ms));
}

/// Nearest-rank quantile, rounded to microseconds; `sorted` is not empty.
double quantile(const std::vector<float>& sorted, double q) {
    const auto rank = static_cast<std::size_t>(q * static_cast<double>(sorted.size()));
    return std::round(static_cast<double>(sorted[std::min(rank, sorted.size() - 1)]) * 1e3) / 1e3;
}

Json timingJson(const Summary& summary) {
    Json json = Json::object();
    for (const auto& [stage, times] : summary.timing) {
        std::vector<float> sorted = times;
        std::sort(sorted.begin(), sorted.end());
        json[stage] = {
            {"median", quantile(sorted, 0.5)}, {"p95", quantile(sorted, 0.95)}, {"p99", quantile(sorted, 0.99)}};
    }
    return json;
}

Json parametersJson(const DetectorParams& params) {
    Json json = Json::object();
    for (const ParamValue& p : listParams(params)) {
        std::visit([&](const auto& value) { json[p.section][p.key] = value; }, p.value);
    }
    return json;
}

}  // namespace

void Summary::add(const PointCloud& cloud, const DetectionResult& result, double decode_ms, double total_ms) {
    ++scans;
    returns += cloud.size();
    for (const Obstacle& o : result.obstacles) ++obstacles[toString(o.cls)];
    for (const RejectedCluster& r : result.clusters.rejected) ++rejected[toString(r.reason)];
    ++ground[toString(result.ground.evidence)];
    addTime(*this, "decode", decode_ms);
    for (const StageTime& t : result.timing) addTime(*this, t.stage, t.ms);
    addTime(*this, "total", total_ms);
}

std::string toJson(const Summary& summary, const Options& options, const DetectorParams& params) {
    Json json;
    json["version"] = LIDAR_OBSTACLES_VERSION;
    json["input"] = options.input;
    json["sensor_label"] = summary.sensor_label;
    json["config"] = options.config.empty() ? "built-in defaults" : options.config;
    json["damage"] = summary.damage.empty() ? Json() : Json(summary.damage);
    json["interrupted_at"] = summary.interrupted_at ? Json(*summary.interrupted_at) : Json();
    json["in_place"] = summary.moved ? Json(lidar_obstacles::toText(summary.in_place)) : Json();
    json["remarks"] = summary.remarks.empty() ? Json() : Json(summary.remarks);
    json["scans_in_input"] = summary.scans_in_input;
    json["scans"] = summary.scans;
    json["returns"] = summary.returns;
    json["obstacles"] = {{"vehicle", 0}, {"pedestrian", 0}, {"cyclist", 0}, {"structure", 0}, {"unknown", 0}};
    for (const auto& [name, count] : summary.obstacles) json["obstacles"][name] = count;
    json["rejected"] = Json(summary.rejected.empty() ? Json::object() : Json(summary.rejected));
    json["ground"] = {{"good", 0}, {"weak", 0}, {"none", 0}};
    for (const auto& [name, count] : summary.ground) json["ground"][name] = count;
    addMotion(json, summary.motion, params);
    json["zones"] = options.zones.empty() ? Json() : summary.watched.zonesJson();
    json["health"] = summary.watched.healthJson();
    json["timing_ms"] = timingJson(summary);
    json["parameters"] = parametersJson(params);
    // names in the input need not be UTF-8
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lidar_obstacles::apps
