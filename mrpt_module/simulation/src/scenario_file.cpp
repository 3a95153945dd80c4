// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <set>

#include "lidar_obstacles/simulation/scenario.h"
#include "mrpt_bridge/yaml_map.h"
#include "scenario_items.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kLarge = 1e5;

/// Knots from a list of mappings with keys `x` and `y`, x rising.
struct CurveKeys {
    std::string x, y;
    double y_scale = 1.0;
};
Curve readCurve(YamlMap& map, const std::string& key, const CurveKeys& keys) {
    std::vector<Curve::Knot> knots;
    for (YamlMap& entry : map.maps(key)) {
        const double at = entry.number(keys.x, {-1e6, 1e6});
        if (!knots.empty() && at <= knots.back().x) entry.fail(keys.x, "must be larger than the one before");
        knots.push_back({at, keys.y_scale * entry.number(keys.y, {-1e6, 1e6})});
        entry.finish();
    }
    if (knots.empty()) map.fail(key, "must not be empty");
    return Curve(std::move(knots));
}

double radians(double deg) { return deg * M_PI / 180.0; }

/// {straight: metres} or {turn: degrees, radius: metres}
TrackSegment readSegment(YamlMap& map) {
    TrackSegment segment{};
    if (map.has("straight")) {
        segment = {map.number("straight", {0.01, kLarge}), 0.0};
    } else {
        const double turn = radians(map.number("turn", {-720.0, 720.0}));
        segment = {std::abs(turn) * map.number("radius", {1.0, kLarge}), turn};
        if (turn == 0.0) map.fail("turn", "must not be 0; use straight");
    }
    map.finish();
    return segment;
}

/// Height or bank over s; zero if the scenario tells none.
Curve readTrackCurve(YamlMap& map, const std::string& key, double scale) {
    return map.has(key) ? readCurve(map, key, {"s", key == "bank" ? "deg" : "z", scale}) : Curve(0.0);
}

TrackSpec readTrack(YamlMap map) {
    TrackSpec track;
    track.closed = map.flag("closed", false);
    track.width = map.number("width", {0.5, 100.0}, track.width);
    track.heading = radians(map.number("heading", {-360.0, 360.0}, 0.0));
    track.transition = map.number("transition", {0.1, 100.0}, track.transition);
    for (YamlMap& entry : map.maps("segments")) track.segments.push_back(readSegment(entry));
    if (track.segments.empty()) map.fail("segments", "must not be empty");
    track.elevation = readTrackCurve(map, "elevation", 1.0);
    track.bank = readTrackCurve(map, "bank", M_PI / 180.0);
    map.finish();
    return track;
}

TerrainSpec readTerrain(YamlMap map) {
    TerrainSpec terrain;
    terrain.reach = map.number("reach", {5.0, 200.0}, terrain.reach);
    terrain.cell = map.number("cell", {0.25, 10.0}, terrain.cell);
    terrain.roughness = map.number("roughness", {0.0, 2.0}, terrain.roughness);
    if (map.has("verge")) terrain.verge = readCurve(map, "verge", {"beside", "z"});
    map.finish();
    return terrain;
}

Pose6 readPose(YamlMap map) {
    Pose6 pose;
    constexpr Range kPlace{-10.0, 10.0}, kAngle{-180.0, 180.0};
    pose.position = {map.number("x", kPlace, 0.0), map.number("y", kPlace, 0.0), map.number("z", kPlace, 0.0)};
    pose.yaw = radians(map.number("yaw", kAngle, 0.0));
    pose.pitch = radians(map.number("pitch", kAngle, 0.0));
    pose.roll = radians(map.number("roll", kAngle, 0.0));
    map.finish();
    return pose;
}

SensorSpec readSensor(YamlMap map) {
    SensorSpec sensor;
    sensor.label = map.text("label", sensor.label);
    sensor.planes = static_cast<int>(map.number("planes", {4, 16}, sensor.planes));
    const std::string planes = map.text("planes", "16");
    if (planes != "16" && planes != "8" && planes != "4") map.fail("planes", "must be 16, 8 or 4");
    sensor.rate = map.number("rate", {5.0, 20.0}, sensor.rate);
    sensor.pose = readPose(map.map("pose"));
    if (map.has("mount_error")) sensor.mount_error = readPose(map.map("mount_error"));
    sensor.range_noise = map.number("range_noise", {0.0, 1.0}, sensor.range_noise);
    sensor.laser_bias = map.number("laser_bias", {0.0, 1.0}, sensor.laser_bias);
    sensor.min_range = map.number("min_range", {0.1, 10.0}, sensor.min_range);
    sensor.max_range = map.number("max_range", {10.0, 130.0}, sensor.max_range);
    sensor.rain = map.number("rain", {0.0, 1.0}, sensor.rain);
    sensor.dropout = map.number("dropout", {0.0, 1.0}, sensor.dropout);
    map.finish();
    return sensor;
}

EgoSpec readEgo(YamlMap map) {
    EgoSpec ego;
    ego.waypoints = readWaypoints(map, "s");
    ego.wheelbase = map.number("wheelbase", {0.1, 10.0}, ego.wheelbase);
    ego.gauge = map.number("gauge", {0.1, 4.0}, ego.gauge);
    map.finish();
    return ego;
}

bool hasGrid(const Scenario& scenario) {
    return std::any_of(scenario.objects.begin(), scenario.objects.end(),
                       [](const ObjectSpec& o) { return std::holds_alternative<Gridded>(o.motion); });
}

/// @throws ScenarioError if a sensor cannot be told from the others, or turns at another rate.
void readMoreSensors(YamlMap& map, Scenario& scenario) {
    std::set<std::string> labels{scenario.sensor.label};
    for (YamlMap& entry : map.maps("more_sensors")) {
        scenario.more_sensors.push_back(readSensor(entry));
        const SensorSpec& sensor = scenario.more_sensors.back();
        if (!labels.insert(sensor.label).second) entry.fail("label", "must be another one for each sensor");
        if (sensor.rate != scenario.sensor.rate) entry.fail("rate", "must be that of the first sensor");
    }
}

Scenario readScenario(YamlMap map) {
    Scenario scenario;
    scenario.track = readTrack(map.map("track"));
    if (map.has("terrain")) scenario.terrain = readTerrain(map.map("terrain"));
    scenario.sensor = readSensor(map.map("sensor"));
    if (map.has("more_sensors")) readMoreSensors(map, scenario);
    scenario.ego = readEgo(map.map("ego"));
    if (map.has("objects"))
        for (YamlMap& entry : map.maps("objects"))
            for (ObjectSpec& object : readObjects(entry)) scenario.objects.push_back(std::move(object));
    if (map.has("clutter"))
        for (YamlMap& entry : map.maps("clutter"))
            for (const ClutterSpec& thing : readClutter(entry)) scenario.clutter.push_back(thing);
    const bool gridded = hasGrid(scenario);
    if (gridded && scenario.ego.waypoints.size() > 1) map.fail("ego", "must stand still (one way-point) for a grid");
    if (map.has("duration") || !gridded) scenario.duration = map.number("duration", {0.1, kLarge});
    map.finish();
    return scenario;
}

}  // namespace

double durationOf(const Scenario& scenario) {
    if (scenario.duration > 0.0) return scenario.duration;
    std::size_t scans = 0;
    for (const ObjectSpec& o : scenario.objects)
        if (const auto* grid = std::get_if<Gridded>(&o.motion)) scans = std::max(scans, grid->poses());
    return static_cast<double>(scans) / scenario.sensor.rate;
}

Scenario parseScenario(const std::string& text, const std::string& name) {
    try {
        return readScenario(parseYaml(text, name));
    } catch (const YamlError& e) {
        throw ScenarioError(e.what());
    }
}

Scenario loadScenario(const std::string& path) {
    try {
        return readScenario(loadYaml(path));
    } catch (const YamlError& e) {
        throw ScenarioError(e.what());
    }
}

}  // namespace lidar_obstacles::simulation
