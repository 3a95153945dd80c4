// SPDX-License-Identifier: BSD-3-Clause
#include "state_log.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::ordered_json;

Json boxesJson(const ShownScan& scan) {
    Json boxes = Json::array();
    for (const Obstacle& o : scan.result.obstacles) {
        const OrientedBox& b = o.box;
        boxes.push_back(
            {toString(o.cls), b.center.x(), b.center.y(), b.center.z(), b.size.x(), b.size.y(), b.size.z(), b.yaw});
    }
    return boxes;
}

Json rectJson(const ScreenRect& r) { return {r.x, r.y, r.width, r.height}; }

/// What is played.
void addPlayer(const Player& player, Json& json) {
    json["scan"] = player.shown()->scan_index;
    json["playing"] = player.playing();
    json["seeking"] = player.seeking();
    json["provisional"] = player.provisional();
    json["speed"] = player.speed();
    json["loop"] = player.loop();
    if (player.range()) json["range"] = {player.range()->first, player.range()->second};
    json["used"] = player.shown()->used;
    json["returns"] = player.shown()->cloud.size();
    json["boxes"] = boxesJson(*player.shown());
    json["ids"] = Json::array();
    for (const Obstacle& o : player.shown()->result.obstacles) json["ids"].push_back(o.id);
    json["zones"] = Json::array();
    for (const ZoneOutline& z : player.shown()->zones) json["zones"].push_back({z.name, toString(z.state)});
}

/// What the keys have chosen.
void addView(const ViewState& view, const SceneLayers& layers, Json& json) {
    json["color"] = toString(view.color);
    json["camera"] = toString(view.camera);
    json["theme"] = toString(view.look.theme);
    json["text_scale"] = view.look.text_scale;
    json["help"] = view.help;
    json["panel"] = view.panel;
    json["tracks"] = view.tracks;
    json["prompt"] = view.prompt;
    json["message"] = view.message;
    json["layers"] = Json::object();
    for (std::size_t k = 0; k < kLayers; ++k)
        if (view.layers[k]) json["layers"][toString(static_cast<Layer>(k))] = layers.count(static_cast<Layer>(k));
}

/// What was drawn where.
void addDrawn(const Viewer& viewer, const Player& player, Json& json) {
    const Viewer::Drawn& drawn = viewer.drawn();
    const CameraPlace& place = viewer.screen().camera();
    json["azimuth_deg"] = place.azimuth_deg;
    json["elevation_deg"] = place.elevation_deg;
    json["distance"] = place.distance;
    json["looks_at"] = {place.x, place.y, place.z};
    json["window"] = {viewer.screen().width(), viewer.screen().height()};
    json["scene"] = rectJson(drawn.layout.scene);
    json["side"] = rectJson(drawn.layout.side);
    json["chosen"] = viewer.chosen() ? Json(*viewer.chosen()) : Json();
    json["numbers"] = Json::object();
    for (const Line& line : drawn.numbers) json["numbers"][line.name] = line.value;
    json["reasons"] = drawn.reasons;
    json["features"] = Json::object();
    for (const Line& line : drawn.features) json["features"][line.name] = line.value;
    json["features_at"] = {drawn.features_at.x(), drawn.features_at.y()};
    json["history"] = drawn.history;
    json["plots"] = drawn.plots;
    json["legend"] = drawn.legend;
    json["rows"] = drawn.rows;
    json["labels"] = Json::array();
    for (const PlacedLabel& l : drawn.labels) json["labels"].push_back({l.text, rectJson(l.at)});
    json["row_at"] = Json::array();
    for (const auto& at : drawn.row_at) json["row_at"].push_back({at.x(), at.y()});
    json["header_at"] = Json::object();
    for (const auto& [title, at] : drawn.header_at) json["header_at"][title] = {at.x(), at.y()};
    const Projection projection(place, drawn.layout.scene);
    json["box_at"] = Json::array();
    for (const Obstacle& o : player.shown()->result.obstacles)
        if (const auto at = projection.pixelOf(o.box.center)) json["box_at"].push_back({o.id, at->x(), at->y()});
}

void addImage(const Shown& shown, Json& json) {
    if (!shown.image) return;
    json["image"] = {{"camera", shown.image->label}, {"time", shown.image->time}, {"problem", shown.image->problem}};
    json["image"]["at"] = rectJson(shown.viewer.drawn().image);
    json["image"]["boxes"] = Json::array();
    for (const auto& [id, at] : shown.viewer.drawn().in_image) json["image"]["boxes"].push_back({id, at.x(), at.y()});
}

void addOutlines(const Shown& shown, Json& json) {
    if (!shown.view.outlines) return;
    const auto& drawn = shown.viewer.drawn().outlines;
    json["outlines"] = Json::object();
    for (std::size_t o = 0; o < std::min(drawn.size(), shown.outlines.outlines().size()); ++o) {
        const EditedOutline& outline = shown.outlines.outlines()[o];
        Json corners = Json::array(), at = Json::array();
        for (const Eigen::Vector2d& p : outline.corners) corners.push_back({p.x(), p.y()});
        for (const Eigen::Vector2f& p : drawn[o]) at.push_back({p.x(), p.y()});
        json["outlines"][outline.name] = {{"corners", corners}, {"at", at}};
    }
}

void addTimeline(const Shown& shown, Json& json) {
    json["bar"] = rectJson(shown.bar);
    json["surveyed"] = shown.survey.history().scans();
    json["marks"] = Json::array();
    for (const Mark& m : shown.survey.history().marks()) json["marks"].push_back({m.scan, toString(m.kind), m.text});
    json["open_groups"] = shown.parameters.open_groups;
    json["starred"] = shown.parameters.starred;
}

}  // namespace

StateLog::StateLog(const std::string& file) {
    if (file.empty()) return;
    out_.open(file);
    if (!out_) throw std::runtime_error(file + ": cannot write");
}

void StateLog::write(const Shown& shown) {
    if (!out_.is_open() || !shown.player.shown()) return;
    const std::uint64_t frames = shown.viewer.screen().frames();
    Json json;
    json["drawn"] = frames > 0;
    addPlayer(shown.player, json);
    addView(shown.view, shown.viewer.layers(), json);
    addDrawn(shown.viewer, shown.player, json);
    addTimeline(shown, json);
    addImage(shown, json);
    addOutlines(shown, json);
    const std::string state = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (state == last_) return;
    last_ = state;
    json["indexed"] = shown.player.store().size();
    json["frames"] = frames;
    json["time"] = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    out_ << json.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

}  // namespace lidar_obstacles::apps
