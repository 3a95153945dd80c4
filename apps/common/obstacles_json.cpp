// SPDX-License-Identifier: BSD-3-Clause
#include "common/obstacles_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/low_rows.h"
#include "common/zone_rows.h"
#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double steps) { return std::round(value * steps) / steps; }

double metres(double value) { return rounded(value, 1e4); }

Json pairOf(const Eigen::Vector2d& v) { return {rounded(v.x(), 1e3), rounded(v.y(), 1e3)}; }

/// What a tracker knows beside.
void addTrack(Json& json, const TrackState& t) {
    json["age"] = rounded(t.age, 1e3);
    json["seen"] = t.seen;
    json["velocity"] = t.velocity ? pairOf(*t.velocity) : Json();
    json["velocity_std"] = t.velocity ? pairOf(t.velocity_std) : Json();
    json["moving"] = t.velocity ? Json(t.moving) : Json();
    json["direction_known"] = t.direction_known;
    json["yaw_std"] = rounded(t.yaw_std, 1e5);
    json["center_std"] = pairOf(t.center_std);
    json["time_offset"] = rounded(t.time_offset, 1e6);
}

}  // namespace

Json obstacleJson(const Obstacle& o) {
    Json json;
    json["id"] = o.id;
    json["class"] = toString(o.cls);
    json["x"] = metres(o.box.center.x());
    json["y"] = metres(o.box.center.y());
    json["z"] = metres(o.box.center.z());
    json["length"] = metres(o.box.size.x());
    json["width"] = metres(o.box.size.y());
    json["height"] = metres(o.box.size.z());
    json["yaw"] = rounded(o.box.yaw, 1e5);
    json["heading_valid"] = o.heading_valid;
    json["num_points"] = o.num_points;
    json["heading_std"] = rounded(o.heading_std, 1e5);
    json["num_rings"] = o.num_rings;
    json["distance"] = metres(distanceTo(o.box));
    json["heading_rule"] = toString(o.rule);
    json["faces"] = facesText(o.faces);
    json["max_height"] = std::isfinite(o.max_height) ? Json(metres(o.max_height)) : Json();
    json["seen_length"] = metres(o.seen_box.size.x());
    json["seen_width"] = metres(o.seen_box.size.y());
    const float p = probabilityOf(o);
    json["probability"] = p > 0.0f ? Json(rounded(p, 1e4)) : Json();
    if (o.track) addTrack(json, *o.track);
    return json;
}

std::string jsonLine(double timestamp, std::size_t scan_index, const std::vector<Obstacle>& obstacles,
                     const JsonExtras& extras) {
    Json json;
    json["timestamp"] = timestamp;
    json["scan_index"] = scan_index;
    if (extras.zones != nullptr) json["zones"] = zonesJson(*extras.zones);
    if (extras.health != nullptr) json["health"] = healthJson(*extras.health);
    if (extras.low != nullptr) json["low"] = lowJson(*extras.low);
    json["obstacles"] = Json::array();
    for (const Obstacle& o : obstacles) json["obstacles"].push_back(obstacleJson(o));
    return json.dump() + '\n';
}

}  // namespace lidar_obstacles::apps
