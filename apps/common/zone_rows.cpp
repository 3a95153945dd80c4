// SPDX-License-Identifier: BSD-3-Clause
#include "common/zone_rows.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/csv_cell.h"
#include "common/number_text.h"
#include "common/run_app.h"
#include "lidar_obstacles/mrpt_bridge/zones_file.h"

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value) { return value ? Json(thousandths(*value)) : Json(); }

double degrees(double rad) { return std::round(normalizeAngle(rad) * 1.8e4 / M_PI) / 100.0; }

std::string cell(const std::optional<double>& value) { return value ? fixedText(*value, 3) : std::string(); }

/// "blocked", "ring", "turned", "rate", "poses".
std::vector<std::string> faultsOf(const HealthReport& h) {
    std::vector<std::string> names;
    if (!h.blocked.empty()) names.emplace_back("blocked");
    if (!h.silent_rings.empty()) names.emplace_back("silent_rings");
    if (h.turned) names.emplace_back("turned");
    if (h.wrong_rate) names.emplace_back("wrong_rate");
    if (h.poses_lost) names.emplace_back("poses_lost");
    return names;
}

}  // namespace

std::optional<ZoneMonitor> openZones(const std::string& file, const RegionParams& region) {
    if (file.empty()) return std::nullopt;
    try {
        return ZoneMonitor(loadZones(file), region);
    } catch (const ZonesFileError& e) {
        throw UsageError(e.what());
    }
}

Json zonesJson(const ZoneMonitor& zones) {
    Json all = Json::array();
    for (std::size_t k = 0; k < zones.reports().size(); ++k) {
        const ZoneReport& r = zones.reports()[k];
        Json json;
        json["name"] = zones.set().zones[k].name;
        json["state"] = toString(r.state);
        json["reason"] = toString(r.reason);
        json["since"] = r.since;
        json["seen"] = thousandths(r.seen);
        json["nearest"] = number(r.nearest);
        json["time_to_contact"] = number(r.time_to_contact);
        json["returns"] = r.returns;
        json["id"] = r.id < 0 ? Json() : Json(r.id);
        json["class"] = r.id < 0 ? Json() : Json(toString(r.cls));
        all.push_back(std::move(json));
    }
    return all;
}

Json healthJson(const HealthReport& h) {
    Json json;
    json["ok"] = h.ok();
    json["blocked"] = Json::array();
    for (const AzimuthSpan& s : h.blocked) json["blocked"].push_back({degrees(s.from), degrees(s.to)});
    json["silent_rings"] = h.silent_rings;
    json["turned"] = h.turned;
    json["turned_by"] = degrees(h.turned_by);
    json["wrong_rate"] = h.wrong_rate;
    json["rate"] = thousandths(h.rate);
    json["poses_lost"] = h.poses_lost;
    return json;
}

std::string zonesLine(double timestamp, const ZoneMonitor& zones) {
    Json json;
    json["timestamp"] = timestamp;
    json["scan_index"] = nullptr;
    json["zones"] = zonesJson(zones);
    return json.dump() + '\n';
}

std::string zonesCsvHeader() {
    return "timestamp,scan_index,zone,state,reason,since,seen,nearest,time_to_contact,returns,id,class\n";
}

std::string zonesCsvRows(double timestamp, std::size_t scan_index, const ZoneMonitor& zones) {
    std::string rows;
    for (std::size_t k = 0; k < zones.reports().size(); ++k) {
        const ZoneReport& r = zones.reports()[k];
        rows += fixedText(timestamp, 6) + ',' + std::to_string(scan_index) + ',' + csvCell(zones.set().zones[k].name) +
                ',' + toString(r.state) + ',' + toString(r.reason) + ',' + fixedText(r.since, 6) + ',' +
                fixedText(r.seen, 3) + ',' + cell(r.nearest) + ',' + cell(r.time_to_contact) + ',' +
                std::to_string(r.returns) + ',' + (r.id < 0 ? "," : std::to_string(r.id) + ',' + toString(r.cls)) +
                '\n';
    }
    return rows;
}

void ZonesTally::add(std::size_t scan_index, const ZoneMonitor* zones, const HealthReport& health) {
    for (const std::string& name : faultsOf(health)) {
        OfFault& fault = faults_[name];
        if (fault.scans++ > 0) continue;
        fault.first = scan_index;
        fault.text = toText(health);
    }
    if (zones == nullptr) return;
    zones_.resize(zones->reports().size());
    names_.resize(zones_.size());
    for (std::size_t k = 0; k < zones_.size(); ++k) {
        const ZoneReport& r = zones->reports()[k];
        OfZone& zone = zones_[k];
        names_[k] = zones->set().zones[k].name;
        ++zone.states[toString(r.state)];
        if (r.reason != ZoneReason::None) ++zone.reasons[toString(r.reason)];
        if (r.state == ZoneState::Occupied && zone.last != r.state) ++zone.alarms;
        zone.last = r.state;
        if (r.nearest && (!zone.nearest || *r.nearest < *zone.nearest)) zone.nearest = r.nearest;
    }
}

Json ZonesTally::zonesJson() const {
    Json all = Json::object();
    for (std::size_t k = 0; k < zones_.size(); ++k) {
        Json json = {{"free", 0}, {"occupied", 0}, {"unknown", 0}};
        for (const auto& [name, count] : zones_[k].states) json[name] = count;
        json["reasons"] = zones_[k].reasons;
        json["times_occupied"] = zones_[k].alarms;
        json["nearest"] = number(zones_[k].nearest);
        all[names_[k]] = std::move(json);
    }
    return all;
}

Json ZonesTally::healthJson() const {
    Json all = Json::object();
    for (const auto& [name, fault] : faults_)
        all[name] = {{"scans", fault.scans}, {"first", fault.first}, {"text", fault.text}};
    return all;
}

std::string ZonesTally::healthText() const {
    std::string all;
    for (const auto& [name, fault] : faults_)
        all += (all.empty() ? "health: " : "; ") + fault.text + " (from scan " + std::to_string(fault.first) + ", " +
               std::to_string(fault.scans) + " scans)";
    return all;
}

}  // namespace lidar_obstacles::apps
