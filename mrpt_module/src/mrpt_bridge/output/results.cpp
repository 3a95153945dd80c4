// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/results.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace lidar_obstacles {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "lidar_obstacles ";
constexpr int kClasses = static_cast<int>(std::tuple_size_v<ClassProbabilities>);
constexpr int kRules = 4;

double finite(double value) {
    if (!std::isfinite(value)) throw std::invalid_argument("results with a number that is not finite");
    return value;
}

Json pairJson(const Eigen::Vector2d& v) { return {finite(v.x()), finite(v.y())}; }

Json boxJson(const OrientedBox& b) {
    Json json;
    for (const Eigen::Vector3d& v : {b.center, b.size})
        for (int i = 0; i < 3; ++i) json.push_back(finite(v[i]));
    json.push_back(finite(b.yaw));
    return json;
}

Json trackJson(const TrackState& t) {
    return {{"age", finite(t.age)},
            {"seen", t.seen},
            {"velocity", t.velocity ? pairJson(*t.velocity) : Json()},
            {"velocity_std", pairJson(t.velocity_std)},
            {"center_std", pairJson(t.center_std)},
            {"yaw_std", finite(t.yaw_std)},
            {"moving", t.moving},
            {"direction_known", t.direction_known},
            {"time_offset", finite(t.time_offset)}};
}

Json obstacleJson(const Obstacle& o) {
    Json json{{"id", o.id},
              {"class", toString(o.cls)},
              {"probability", Json::array()},
              {"box", boxJson(o.box)},
              {"seen_box", boxJson(o.seen_box)},
              {"heading_valid", o.heading_valid},
              {"heading_std", finite(o.heading_std)},
              {"num_points", o.num_points},
              {"num_rings", o.num_rings},
              {"max_height", std::isinf(o.max_height) ? Json() : Json(finite(o.max_height))},
              {"heading_rule", toString(o.rule)},
              {"faces", o.faces}};
    for (const float p : o.probability) json["probability"].push_back(finite(p));
    if (o.track) json["track"] = trackJson(*o.track);
    return json;
}

/// The value of an enumeration that has this name.
template <class Enum>
Enum named(const std::string& name, int count) {
    for (int i = 0; i < count; ++i)
        if (name == toString(static_cast<Enum>(i))) return static_cast<Enum>(i);
    throw std::runtime_error("unknown word '" + name + "'");
}

Eigen::Vector2d pairOf(const Json& json) { return {json.at(0).get<double>(), json.at(1).get<double>()}; }

OrientedBox boxOf(const Json& json) {
    OrientedBox b;
    for (int i = 0; i < 3; ++i) {
        b.center[i] = json.at(static_cast<std::size_t>(i)).get<double>();
        b.size[i] = json.at(static_cast<std::size_t>(i) + 3).get<double>();
    }
    b.yaw = json.at(6).get<double>();
    return b;
}

TrackState trackOf(const Json& json) {
    TrackState t;
    json.at("age").get_to(t.age);
    json.at("seen").get_to(t.seen);
    if (!json.at("velocity").is_null()) t.velocity = pairOf(json["velocity"]);
    t.velocity_std = pairOf(json.at("velocity_std"));
    t.center_std = pairOf(json.at("center_std"));
    json.at("yaw_std").get_to(t.yaw_std);
    json.at("moving").get_to(t.moving);
    json.at("direction_known").get_to(t.direction_known);
    json.at("time_offset").get_to(t.time_offset);
    return t;
}

Obstacle obstacleOf(const Json& json) {
    Obstacle o;
    json.at("id").get_to(o.id);
    o.cls = named<ObstacleClass>(json.at("class").get<std::string>(), kClasses);
    for (std::size_t c = 0; c < o.probability.size(); ++c) json.at("probability").at(c).get_to(o.probability[c]);
    o.box = boxOf(json.at("box"));
    o.seen_box = boxOf(json.at("seen_box"));
    json.at("heading_valid").get_to(o.heading_valid);
    json.at("heading_std").get_to(o.heading_std);
    json.at("num_points").get_to(o.num_points);
    json.at("num_rings").get_to(o.num_rings);
    const Json& height = json.at("max_height");
    o.max_height = height.is_null() ? std::numeric_limits<double>::infinity() : height.get<double>();
    o.rule = named<HeadingRule>(json.at("heading_rule").get<std::string>(), kRules);
    json.at("faces").get_to(o.faces);
    if (json.contains("track")) o.track = trackOf(json["track"]);
    return o;
}

mrpt::obs::CObservationRFID::TTagReading row(const std::string& title, const Json& json) {
    mrpt::obs::CObservationRFID::TTagReading reading;
    reading.power = 0.0;
    reading.antennaPort = title;
    reading.epc = json.dump(-1, ' ', false, Json::error_handler_t::replace);  // a label need not be UTF-8
    return reading;
}

ScanResults resultsOf(const std::vector<mrpt::obs::CObservationRFID::TTagReading>& rows) {
    const std::string version = rows.front().antennaPort.substr(std::char_traits<char>::length(kFormat));
    if (std::stoi(version) > kResultsVersion)
        throw std::runtime_error("of version " + version + ", this program reads them up to version " +
                                 std::to_string(kResultsVersion));
    const Json head = Json::parse(rows.front().epc);
    ScanResults results;
    head.at("timestamp").get_to(results.timestamp);
    head.at("scan_label").get_to(results.scan_label);
    const auto count = head.at("obstacles").get<std::size_t>();
    if (count != rows.size() - 1)
        throw std::runtime_error(std::to_string(rows.size() - 1) + " obstacles where there should be " +
                                 std::to_string(count));
    results.obstacles.reserve(count);
    for (std::size_t i = 1; i < rows.size(); ++i) results.obstacles.push_back(obstacleOf(Json::parse(rows[i].epc)));
    return results;
}

}  // namespace

mrpt::obs::CObservationRFID::Ptr toResultsObservation(const ScanResults& results) {
    auto observation = mrpt::obs::CObservationRFID::Create();
    observation->timestamp = mrpt::Clock::fromDouble(finite(results.timestamp));
    observation->sensorLabel = results.scan_label.empty() ? "results" : results.scan_label + "_results";
    observation->tag_readings.reserve(results.obstacles.size() + 1);
    observation->tag_readings.push_back(
        row(kFormat + std::to_string(kResultsVersion), {{"timestamp", results.timestamp},
                                                        {"scan_label", results.scan_label},
                                                        {"obstacles", results.obstacles.size()}}));
    for (const Obstacle& o : results.obstacles)
        observation->tag_readings.push_back(row(toString(o.cls) + (" " + std::to_string(o.id)), obstacleJson(o)));
    return observation;
}

std::optional<ScanResults> readResults(const mrpt::obs::CObservation& observation) {
    const auto* carrier = dynamic_cast<const mrpt::obs::CObservationRFID*>(&observation);
    if (!carrier || carrier->tag_readings.empty()) return std::nullopt;
    if (carrier->tag_readings.front().antennaPort.rfind(kFormat, 0) != 0) return std::nullopt;
    try {
        return resultsOf(carrier->tag_readings);
    } catch (const std::exception& e) {
        throw std::runtime_error("results '" + observation.sensorLabel + "' cannot be read: " + e.what());
    }
}

}  // namespace lidar_obstacles
