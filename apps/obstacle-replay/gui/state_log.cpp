#include "state_log.h"

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

}  // namespace

StateLog::StateLog(const std::string& file) {
    if (file.empty()) return;
    out_.open(file);
    if (!out_) throw std::runtime_error(file + ": cannot write");
}

void StateLog::write(const Player& player, const ViewState& view, const SceneLayers& layers,
                     const DisplayWindow& window) {
    if (!out_.is_open() || !player.shown()) return;
    Json json;
    json["scan"] = player.shown()->scan_index;
    const std::uint64_t frames = window.frames();
    json["drawn"] = frames > 0;
    json["playing"] = player.playing();
    json["seeking"] = player.seeking();
    json["provisional"] = player.provisional();
    json["speed"] = player.speed();
    json["loop"] = player.loop();
    json["color"] = toString(view.color);
    json["camera"] = toString(view.camera);
    const CameraPlace place = window.camera();
    json["azimuth_deg"] = place.azimuth_deg;
    json["elevation_deg"] = place.elevation_deg;
    json["distance"] = place.distance;
    json["help"] = view.help;
    json["panel"] = view.panel;
    json["tracks"] = view.tracks;
    json["prompt"] = view.prompt;
    json["message"] = view.message;
    json["layers"] = Json::object();
    for (std::size_t k = 0; k < kLayers; ++k)
        if (view.layers[k]) json["layers"][toString(static_cast<Layer>(k))] = layers.count(static_cast<Layer>(k));
    json["used"] = player.shown()->used;
    json["returns"] = player.shown()->cloud.size();
    json["boxes"] = boxesJson(*player.shown());
    const std::string state = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (state == last_) return;
    last_ = state;
    json["indexed"] = player.store().size();
    json["frames"] = frames;
    json["time"] = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    out_ << json.dump(-1, ' ', false, Json::error_handler_t::replace) << std::endl;
}

}  // namespace lidar_obstacles::apps
