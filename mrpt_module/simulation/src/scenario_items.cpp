// SPDX-License-Identifier: BSD-3-Clause
#include "scenario_items.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/simulation/models.h"
#include "lidar_obstacles/simulation/random.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr Range kAlong{-1e5, 1e5}, kBeside{-200.0, 200.0}, kTurn{-360.0, 360.0}, kSize{0.01, 200.0};
constexpr Range kSpacing{0.1, 1e4}, kTime{0.0, 1e5};
constexpr Range kFreePath{0.0, 2.0};
constexpr double kDenseLeaves = 0.03;  ///< of plants that are no shells [m]
constexpr double kLongestRow = 1e4;

double radians(double deg) { return deg * M_PI / 180.0; }

/// What a kind of clutter is called and how large it is if the scenario does not say.
struct ClutterDefaults {
    const char* name;
    ClutterKind kind;
    bool is_line;
    double length, width, height;
};

constexpr ClutterDefaults kClutter[] = {
    {"tree", ClutterKind::Tree, false, 0.0, 4.0, 8.0},
    {"bush", ClutterKind::Bush, false, 0.0, 1.5, 1.2},
    {"pole", ClutterKind::Pole, false, 0.0, 0.16, 6.0},
    {"bollard", ClutterKind::Bollard, false, 0.0, 0.2, 0.9},
    {"bin", ClutterKind::Bin, false, 0.6, 0.6, 1.1},
    {"sign", ClutterKind::Sign, false, 0.0, 0.6, 2.6},
    {"bike", ClutterKind::Bike, false, 1.75, 0.5, 1.05},
    {"building", ClutterKind::Building, false, 12.0, 8.0, 7.0},
    {"step", ClutterKind::Step, false, 1.2, 0.5, 0.35},
    {"ramp", ClutterKind::Ramp, false, 4.0, 3.0, 0.5},
    {"wall", ClutterKind::Wall, true, 0.0, 0.3, 2.0},
    {"fence", ClutterKind::Fence, true, 0.0, 0.06, 1.4},
    {"hedge", ClutterKind::Hedge, true, 0.0, 0.8, 1.5},
    {"rail", ClutterKind::Rail, true, 0.0, 0.12, 0.75},
    {"kerb", ClutterKind::Kerb, true, 0.0, 0.3, 0.12},
    {"sidewalk", ClutterKind::Sidewalk, true, 0.0, 2.5, 0.12},
    {"bridge", ClutterKind::Bridge, false, 30.0, 8.0, 5.2},
    {"shrub", ClutterKind::Shrub, false, 1.2, 1.2, 1.0},
    {"reed", ClutterKind::Reed, false, 1.0, 1.0, 1.0},
    {"open_wall", ClutterKind::OpenWall, false, 10.0, 0.25, 2.4},
    {"panel", ClutterKind::Panel, false, 5.0, 0.08, 1.4},
    {"scaffold", ClutterKind::Scaffold, false, 10.0, 1.0, 6.0},
    {"stairs", ClutterKind::Stairs, false, 2.0, 2.0, 1.0},
    {"barrier", ClutterKind::Barrier, false, 3.0, 0.6, 0.85},
    {"bench", ClutterKind::Bench, false, 1.8, 0.55, 0.85},
    {"table", ClutterKind::Table, false, 1.8, 1.7, 0.75},
    {"kiosk", ClutterKind::Kiosk, false, 3.0, 2.5, 2.6},
    {"shelter", ClutterKind::Shelter, false, 4.0, 1.5, 2.5},
    {"cabinet", ClutterKind::Cabinet, false, 0.8, 0.5, 1.2},
    {"planter", ClutterKind::Planter, false, 1.2, 0.8, 1.1},
    {"carts", ClutterKind::Carts, false, 2.5, 0.6, 1.0},
    {"crate", ClutterKind::Crate, false, 1.2, 0.8, 1.0},
    {"skip", ClutterKind::Skip, false, 4.0, 1.8, 1.5},
    {"pile", ClutterKind::Pile, false, 3.0, 2.0, 1.0},
    {"scooter", ClutterKind::Scooter, false, 1.1, 0.45, 1.1},
    {"lamp", ClutterKind::Lamp, false, 0.0, 0.14, 6.0},
    {"board", ClutterKind::Board, false, 0.0, 2.0, 2.5},
    {"cone", ClutterKind::Cone, false, 0.0, 0.36, 0.7},
};

const ClutterDefaults& clutterNamed(const YamlMap& map, const std::string& name) {
    std::string names;
    for (const ClutterDefaults& c : kClutter) {
        if (name == c.name) return c;
        names += (names.empty() ? "" : ", ") + std::string(c.name);
    }
    map.fail("type", "must be one of " + names + ", not '" + name + "'");
}

std::string knownModel(const YamlMap& map, const std::string& name) {
    const std::vector<std::string> names = modelNames();
    if (std::find(names.begin(), names.end(), name) != names.end()) return name;
    std::string list;
    for (const std::string& n : names) list += (list.empty() ? "" : ", ") + n;
    map.fail("model", "must be one of " + list + ", not '" + name + "'");
}

/// What makes things of a kind differ.
std::uint64_t readVariant(YamlMap& map) { return static_cast<std::uint64_t>(map.number("variant", {0.0, 1e9}, 0.0)); }

/// Values `from`, from + every ... up to `to`.
std::vector<double> evenly(YamlMap& map) {
    const double from = map.number("from", kAlong), to = map.number("to", kAlong),
                 every = map.number("every", kSpacing);
    if (to < from) map.fail("to", "must not be smaller than from");
    if ((to - from) / every > kLongestRow) map.fail("every", "makes a row of more than 10000");
    std::vector<double> values;
    for (double s = from; s <= to; s += every) values.push_back(s);
    return values;
}

std::vector<double> inRadians(std::vector<double> degrees) {
    for (double& value : degrees) value = radians(value);
    return degrees;
}

Gridded readGrid(YamlMap map) {
    Gridded grid;
    grid.ranges = map.numbers("ranges", {0.1, 200.0});
    grid.bearings = inRadians(map.numbers("bearings", kTurn));
    grid.yaws = inRadians(map.numbers("yaws", kTurn));
    map.finish();
    return grid;
}

/// A row of standing objects; the models take turns.
std::vector<ObjectSpec> readRow(YamlMap map, const std::vector<std::string>& models) {
    std::vector<ObjectSpec> row;
    const double d = map.number("d", kBeside), yaw = radians(map.number("yaw", kTurn, 0.0));
    const double jitter = map.number("jitter", {0.0, 100.0}, 0.0);
    for (double s : evenly(map)) {
        Random random(row.size(), static_cast<std::uint64_t>(std::llround(1e3 * std::abs(s))));
        const double shift = random.uniform(-jitter, jitter);
        row.push_back({models[row.size() % models.size()], Standing{s + shift, d + 0.1 * shift, yaw}, 0});
    }
    map.finish();
    return row;
}

bool needsLeaves(ClutterKind kind) { return kind == ClutterKind::Shrub || kind == ClutterKind::Reed; }

void readSize(YamlMap& map, const ClutterDefaults& defaults, ClutterSpec& spec) {
    spec.height = map.number("height", kSize, defaults.height);
    spec.width = map.number("width", kSize, defaults.width);
    spec.length = defaults.length;
    if (defaults.length > 0.0) spec.length = map.number("length", kSize, defaults.length);
    if (!defaults.is_line) spec.yaw = radians(map.number("yaw", kTurn, 0.0));
    spec.leaves = map.number("leaves", kFreePath, needsLeaves(spec.kind) ? kDenseLeaves : spec.leaves);
    spec.roughness = map.number("roughness", {0.0, 2.0}, spec.roughness);
}

/// Where along the track: one stretch of a line, one place, or a row of places.
std::vector<ClutterSpec> readPlaces(YamlMap& map, const ClutterDefaults& defaults, ClutterSpec spec) {
    if (defaults.is_line) {
        spec.from = map.number("from", kAlong);
        spec.to = map.number("to", kAlong);
        if (spec.to <= spec.from) map.fail("to", "must be larger than from");
        return {spec};
    }
    if (map.has("s")) {
        spec.from = map.number("s", kAlong);
        return {spec};
    }
    std::vector<ClutterSpec> row;
    const double jitter = map.number("jitter", {0.0, 100.0}, 0.0);
    for (double s : evenly(map)) {
        spec.variant = row.size();
        Random random(row.size(), static_cast<std::uint64_t>(std::llround(1e3 * std::abs(s))));
        row.push_back(spec);
        row.back().from = s + random.uniform(-jitter, jitter);
        row.back().d += random.uniform(-0.5, 0.5) * jitter;
        row.back().height *= random.uniform(0.8, 1.2);
    }
    return row;
}

}  // namespace

std::vector<Waypoint> readWaypoints(YamlMap& map, const std::string& s_key) {
    std::vector<Waypoint> path;
    for (YamlMap& entry : map.maps("path")) {
        Waypoint w{entry.number("t", kTime), entry.number(s_key, kAlong), entry.number("d", kBeside, 0.0)};
        if (!path.empty() && w.t <= path.back().t) entry.fail("t", "must be larger than the one before");
        entry.finish();
        path.push_back(w);
    }
    if (path.empty()) map.fail("path", "must not be empty");
    return path;
}

std::vector<ObjectSpec> readObjects(YamlMap& map) {
    std::vector<std::string> models = map.texts("model");
    for (const std::string& model : models) knownModel(map, model);
    std::vector<ObjectSpec> objects;
    if (map.has("row")) {
        objects = readRow(map.map("row"), models);
    } else if (models.size() > 1) {
        map.fail("model", "only a row may have several models");
    } else if (map.has("grid")) {
        objects.push_back({models[0], readGrid(map.map("grid")), 0});
    } else if (map.has("path")) {
        Moving moving;
        moving.follows_ego = map.flag("follow_ego", false);
        moving.waypoints = readWaypoints(map, moving.follows_ego ? "ahead" : "s");
        objects.push_back({models[0], moving, 0});
    } else {
        objects.push_back(
            {models[0],
             Standing{map.number("s", kAlong), map.number("d", kBeside, 0.0), radians(map.number("yaw", kTurn, 0.0))},
             0});
    }
    const std::uint64_t variant = readVariant(map);
    for (std::size_t i = 0; i < objects.size(); ++i) objects[i].variant = variant == 0 ? 0 : variant + i;
    map.finish();
    return objects;
}

std::vector<ClutterSpec> readClutter(YamlMap& map) {
    const std::string type = map.text("type");
    const ClutterDefaults& defaults = clutterNamed(map, type);
    ClutterSpec spec;
    spec.kind = defaults.kind;
    readSize(map, defaults, spec);
    const std::vector<double> sides = map.has("d") ? map.numbers("d", kBeside) : std::vector<double>{0.0};
    const std::uint64_t variant = readVariant(map);
    std::vector<ClutterSpec> all;
    for (double d : sides) {
        spec.d = d;
        for (ClutterSpec place : readPlaces(map, defaults, spec)) {
            place.variant = 1000 * place.variant + all.size() + variant;
            all.push_back(place);
        }
    }
    map.finish();
    return all;
}

}  // namespace lidar_obstacles::simulation
