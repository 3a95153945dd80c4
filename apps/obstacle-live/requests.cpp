// SPDX-License-Identifier: BSD-3-Clause
#include "requests.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "pose_input.h"

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::json;

constexpr const char* kExpected =
    R"(expected a line of JSON with one key: {"subscribe": ["tracks", ..]}, {"detection": "start"}, )"
    R"({"detection": "stop"}, {"set": ["SECTION.KEY=VALUE", ..]} or {"pose": {"timestamp": .., ..}})";

std::string quoted(const std::string& text) { return '"' + text + '"'; }

/// ` (did you mean "tracks"?)` or nothing.
std::string meant(const std::string& word, const std::vector<std::string>& names) {
    const std::string nearest = nearestName(word, names);
    return nearest.empty() ? nearest : " (did you mean " + quoted(nearest) + "?)";
}

std::vector<std::string> textsOf(const Json& json, const std::string& expected) {
    std::vector<std::string> texts;
    if (!json.is_array()) throw std::invalid_argument(expected);
    texts.reserve(json.size());
    for (const Json& text : json) {
        if (!text.is_string()) throw std::invalid_argument(expected);
        texts.push_back(text.get<std::string>());
    }
    return texts;
}

Request parseSubscribe(const Json& json) {
    std::vector<std::string> names;
    std::string list;
    names.reserve(kPartCount);
    for (std::size_t k = 0; k < kPartCount; ++k) {
        names.emplace_back(toString(static_cast<Part>(k)));
        list += (k == 0 ? "" : ", ") + names.back();
    }
    Subscribe subscribe;
    for (const std::string& name : textsOf(json, "subscribe: expected a list of " + list)) {
        const auto part = partOf(name);
        if (!part)
            throw std::invalid_argument("subscribe: " + quoted(name) + " is not known" + meant(name, names) +
                                        "; expected some of " + list);
        subscribe.parts |= only(*part);
    }
    return subscribe;
}

Request parseDetection(const Json& json) {
    if (json != "start" && json != "stop") throw std::invalid_argument(R"(detection: expected "start" or "stop")");
    return Detection{json == "start"};
}

Request parseSet(const Json& json) {
    SetParameters set{textsOf(json, R"(set: expected a list of "SECTION.KEY=VALUE")")};
    if (set.assignments.empty()) throw std::invalid_argument(R"(set: expected at least one "SECTION.KEY=VALUE")");
    return set;
}

/// @throws std::invalid_argument unless it is an object with one key, named once.
Json parseObject(const std::string& line) {
    int keys = 0;
    const auto count = [&keys](int depth, Json::parse_event_t event, Json&) {
        keys += event == Json::parse_event_t::key && depth == 1 ? 1 : 0;
        return true;
    };
    Json json = Json::parse(line, count, false);
    if (!json.is_object() || keys != 1) throw std::invalid_argument(kExpected);
    return json;
}

}  // namespace

Request parseRequest(const std::string& line) {
    const Json json = parseObject(line);
    const std::string& key = json.begin().key();
    const Json& value = json.begin().value();
    if (key == "subscribe") return parseSubscribe(value);
    if (key == "detection") return parseDetection(value);
    if (key == "set") return parseSet(value);
    if (key == "pose") return GivePose{parsePose(value)};
    throw std::invalid_argument("unknown request " + quoted(key) +
                                meant(key, {"subscribe", "detection", "set", "pose"}) + "; " + kExpected);
}

bool isHttp(const std::string& line) { return line.find(" HTTP/") != std::string::npos && line.front() != '{'; }

std::string okLine(const std::string& request) {
    Json json;
    json["ok"] = Json::parse(request);
    return json.dump() + '\n';
}

std::string errorLine(const std::string& error, const std::string& request) {
    constexpr std::size_t kShown = 200;
    nlohmann::ordered_json json;
    json["error"] = error;
    json["request"] = request.substr(0, kShown);
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace lidar_obstacles::apps
