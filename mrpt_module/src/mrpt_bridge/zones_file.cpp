// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/zones_file.h"

#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "mrpt_bridge/yaml_map.h"
#include "scan/place_text.h"

namespace lidar_obstacles {
namespace {

constexpr Range kPlace{-99999.0, 99999.0};  ///< of a corner [m]

Outline readOutline(YamlMap& map, const std::string& key) {
    Outline outline;
    for (const auto& [x, y] : map.pairs(key, kPlace)) outline.emplace_back(x, y);
    const std::string fault = faultOf(outline);
    if (!fault.empty()) map.fail(key, fault);
    return outline;
}

std::array<bool, 5> readClasses(YamlMap& map) {
    std::array<bool, 5> classes{};
    std::string known;
    for (std::size_t c = 0; c < classes.size(); ++c)
        known += std::string(c == 0 ? "" : ", ") + toString(static_cast<ObstacleClass>(c));
    for (const std::string& word : map.texts("classes")) {
        std::size_t c = 0;
        while (c < classes.size() && word != toString(static_cast<ObstacleClass>(c))) ++c;
        if (c == classes.size()) map.fail("classes", "'" + word + "' is none of " + known);
        classes[c] = true;
    }
    return classes;
}

ZoneRule readRule(YamlMap& map) {
    ZoneRule rule;
    if (map.has("nearest")) rule.nearest = map.number("nearest", {0.01, 200.0});
    if (map.has("time_to_contact")) rule.time_to_contact = map.number("time_to_contact", {0.05, 60.0});
    if (map.has("classes")) rule.classes = readClasses(map);
    rule.min_probability = map.number("min_probability", {0.0, 1.0}, rule.min_probability);
    rule.min_age = map.number("min_age", {0.0, 60.0}, rule.min_age);
    const double returns = map.number("min_returns", {1.0, 1000.0}, rule.min_returns);
    rule.min_returns = static_cast<int>(returns);
    if (rule.min_returns != returns) map.fail("min_returns", "must be a whole number");
    rule.min_height = map.number("min_height", {0.0, 10.0}, rule.min_height);
    rule.max_height = map.number("max_height", {0.1, 10.0}, rule.max_height);
    rule.margin = map.number("margin", {0.0, 5.0}, rule.margin);
    rule.object_height = map.number("object_height", {0.1, 10.0}, rule.object_height);
    rule.min_seen = map.number("min_seen", {0.0, 1.0}, rule.min_seen);
    rule.on_after = map.number("on_after", {0.0, 10.0}, rule.on_after);
    rule.off_after = map.number("off_after", {0.0, 60.0}, rule.off_after);
    return rule;
}

bool isUtf8(const std::string& text) {
    try {
        return !nlohmann::json(text).dump().empty();
    } catch (const nlohmann::json::type_error&) {
        return false;
    }
}

Zone readZone(YamlMap& map, bool has_vehicle) {
    Zone zone;
    zone.name = map.text("name");
    if (!isUtf8(zone.name)) map.fail("name", "is not UTF-8 text, which outputs of zones are");
    const std::string frame = map.text("frame", "vehicle");
    if (frame != "vehicle" && frame != "map") map.fail("frame", "must be vehicle or map, not '" + frame + "'");
    zone.frame = frame == "map" ? ZoneFrame::Map : ZoneFrame::Vehicle;
    zone.polygon = readOutline(map, "polygon");
    zone.rule = readRule(map);
    if (!has_vehicle)
        for (const char* key : {"nearest", "time_to_contact"})
            if (map.has(key)) map.fail(key, "needs `vehicle`, the outline that it is measured from");
    map.finish();
    return zone;
}

ZoneSet readZones(YamlMap map) {
    ZoneSet set;
    if (map.has("vehicle")) set.vehicle = readOutline(map, "vehicle");
    if (map.has("max_latency")) set.max_latency = map.number("max_latency", {0.001, 60.0});
    std::set<std::string> names;
    std::vector<YamlMap> zones = map.maps("zones");
    if (zones.empty()) map.fail("zones", "must not be empty");
    set.zones.reserve(zones.size());
    for (YamlMap& entry : zones) {
        set.zones.push_back(readZone(entry, !set.vehicle.empty()));
        if (!names.insert(set.zones.back().name).second)
            entry.fail("name", "there is another zone '" + set.zones.back().name + "'");
    }
    map.finish();
    validate(set);
    return set;
}

std::string outlineText(const Outline& outline) {
    std::string text = "[";
    for (const Eigen::Vector2d& p : outline)
        text += (text.size() > 1 ? ", [" : "[") + numberText(p.x()) + ", " + numberText(p.y()) + "]";
    return text + "]";
}

std::string classesText(const std::array<bool, 5>& classes) {
    std::string text = "[";
    for (std::size_t c = 0; c < classes.size(); ++c)
        if (classes[c]) text += (text.size() > 1 ? ", " : "") + std::string(toString(static_cast<ObstacleClass>(c)));
    return text + "]";
}

/// The keys of a rule that are not as they are without being told.
std::string ruleText(const ZoneRule& rule) {
    const ZoneRule usual;
    std::string text;
    const auto add = [&text](const char* key, const std::string& value) {
        text += std::string("    ") + key + ": " + value + "\n";
    };
    if (rule.nearest) add("nearest", numberText(*rule.nearest));
    if (rule.time_to_contact) add("time_to_contact", numberText(*rule.time_to_contact));
    if (rule.classes != usual.classes) add("classes", classesText(rule.classes));
    const auto unless = [&](const char* key, double value, double as_usual) {
        if (value != as_usual) add(key, numberText(value));
    };
    unless("min_probability", rule.min_probability, usual.min_probability);
    unless("min_age", rule.min_age, usual.min_age);
    unless("min_returns", rule.min_returns, usual.min_returns);
    unless("min_height", rule.min_height, usual.min_height);
    unless("max_height", rule.max_height, usual.max_height);
    unless("margin", rule.margin, usual.margin);
    unless("object_height", rule.object_height, usual.object_height);
    unless("min_seen", rule.min_seen, usual.min_seen);
    unless("on_after", rule.on_after, usual.on_after);
    unless("off_after", rule.off_after, usual.off_after);
    return text;
}

}  // namespace

std::string zonesText(const ZoneSet& set) {
    std::string text;
    if (!set.vehicle.empty()) text += "vehicle: " + outlineText(set.vehicle) + "\n";
    if (set.max_latency) text += "max_latency: " + numberText(*set.max_latency) + "\n";
    text += "zones:\n";
    for (const Zone& zone : set.zones) {
        text += "  - name: " + nlohmann::json(zone.name).dump() + "\n";
        if (zone.frame == ZoneFrame::Map) text += "    frame: map\n";
        text += "    polygon: " + outlineText(zone.polygon) + "\n" + ruleText(zone.rule);
    }
    return text;
}

ZoneSet loadZones(const std::string& path) {
    try {
        return readZones(loadYaml(path));
    } catch (const YamlError& e) {
        throw ZonesFileError(e.what());
    }
}

ZoneSet parseZones(const std::string& text, const std::string& name) {
    try {
        return readZones(parseYaml(text, name));
    } catch (const YamlError& e) {
        throw ZonesFileError(e.what());
    }
}

}  // namespace lidar_obstacles
