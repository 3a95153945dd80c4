// SPDX-License-Identifier: BSD-3-Clause
#include "parts.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/low_rows.h"
#include "common/number_text.h"
#include "common/obstacles_json.h"
#include "common/zone_rows.h"
#include "lidar_obstacles/grid_image.h"
#include "lidar_obstacles/mrpt_bridge/navigation.h"

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, kPartCount> kNames = {"zones",  "health",       "obstacles", "tracks", "structure",
                                                        "points", "virtual_scan", "grid",      "low"};

bool isChosen(const ClassChoice& classes, ObstacleClass cls) { return classes.empty() || classes.count(cls) > 0; }

template <class Wanted>
Json obstaclesJson(const SearchedScan& scan, const Wanted& wanted) {
    Json all = Json::array();
    for (const Obstacle& o : scan.found.detection.obstacles)
        if (isChosen(scan.classes, o.cls) && wanted(o)) all.push_back(obstacleJson(o));
    return all;
}

/// [x, y, z, x, y, z, ..]
Json pointsJson(const SequenceResult& found) {
    const auto map = toPointsMap(found.cloud, found.detection);
    Json json = Json::array();
    auto& numbers = json.get_ref<Json::array_t&>();
    numbers.reserve(3 * map.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
        float x = 0.0F, y = 0.0F, z = 0.0F;
        map.getPointFast(i, x, y, z);
        for (const float value : {x, y, z}) numbers.emplace_back(thousandths(static_cast<double>(value)));
    }
    return json;
}

Json virtualScanJson(const SequenceResult& found) {
    const auto scan = toVirtualScan(found.cloud, found.detection);
    const std::size_t rays = scan.getScanSize();
    const double step = 2.0 * M_PI / static_cast<double>(rays);
    Json json;
    json["angle_min"] = -M_PI + 0.5 * step;
    json["angle_increment"] = step;
    json["range_max"] = thousandths(static_cast<double>(scan.maxRange));
    json["ranges"] = Json::array();
    for (std::size_t i = 0; i < rays; ++i)
        json["ranges"].push_back(
            scan.getScanRangeValidity(i) ? Json(thousandths(static_cast<double>(scan.getScanRange(i)))) : Json());
    return json;
}

Json gridJson(const OccupancyGrid& grid) {
    Json json, runs = Json::array();
    json["origin"] = {grid.origin.x(), grid.origin.y()};
    json["resolution"] = grid.resolution;
    json["width"] = grid.width;
    json["height"] = grid.height;
    const cv::Mat1b states = stateImage(grid);
    int last = -1, count = 0;
    const auto end = [&] {
        if (count > 0) runs.push_back({last, count});
    };
    for (const std::uint8_t state : states) {
        if (state != last) {
            end();
            last = state;
            count = 0;
        }
        ++count;
    }
    end();
    json["runs"] = std::move(runs);
    return json;
}

Json partJson(Part part, const SearchedScan& scan) {
    const auto is_structure = [](const Obstacle& o) { return o.cls == ObstacleClass::Structure; };
    switch (part) {
        case Part::Zones:
            return zonesJson(*scan.zones);
        case Part::Health:
            return healthJson(scan.health);
        case Part::Obstacles:
            return obstaclesJson(scan, [](const Obstacle&) { return true; });
        case Part::Tracks:
            return obstaclesJson(scan, [&](const Obstacle& o) { return o.track && !is_structure(o); });
        case Part::Structure:
            return obstaclesJson(scan, is_structure);
        case Part::Points:
            return pointsJson(scan.found);
        case Part::VirtualScan:
            return virtualScanJson(scan.found);
        case Part::Grid:
            return gridJson(scan.found.detection.grid);
        case Part::Low:
            return lowJson(scan.found.detection.low);
    }
    return {};
}

/// A line's beginning, without the bracket that ends the object.
std::string opened(const Json& json) {
    std::string text = json.dump();
    text.pop_back();
    return text;
}

std::string memberText(Part part, const Json& json) {
    return std::string(",\"") + toString(part) + "\":" + json.dump();
}

}  // namespace

const char* toString(Part part) { return kNames.at(static_cast<std::size_t>(part)); }

std::optional<Part> partOf(const std::string& name) {
    for (std::size_t k = 0; k < kPartCount; ++k)
        if (name == kNames[k]) return static_cast<Part>(k);
    return std::nullopt;
}

Parts usualParts() { return only(Part::Zones) | only(Part::Health) | only(Part::Obstacles); }

std::string Message::line(const Parts& parts) const {
    std::string line = head;
    for (std::size_t k = 0; k < kPartCount; ++k)
        if (parts.test(k) && text[k]) line += *text[k];
    return line + kTail;
}

Parts Message::parts() const {
    Parts parts;
    for (std::size_t k = 0; k < kPartCount; ++k) parts.set(k, text[k].has_value());
    return parts;
}

Message messageOf(const SearchedScan& scan, const Parts& wanted) {
    Json head;
    head["timestamp"] = scan.found.cloud.timestamp;
    head["scan_index"] = scan.index;
    head["latency_ms"] = thousandths(scan.latency_ms);
    Message message;
    message.head = opened(head);
    for (std::size_t k = 0; k < kPartCount; ++k) {
        const auto part = static_cast<Part>(k);
        if (!wanted.test(k) || (part == Part::Zones && scan.zones == nullptr)) continue;
        message.text[k] = memberText(part, partJson(part, scan));
    }
    return message;
}

Message messageOf(double timestamp, const ZoneMonitor& zones) {
    Json head;
    head["timestamp"] = timestamp;
    head["scan_index"] = nullptr;
    Message message;
    message.head = opened(head);
    message.text[static_cast<std::size_t>(Part::Zones)] = memberText(Part::Zones, zonesJson(zones));
    return message;
}

}  // namespace lidar_obstacles::apps
