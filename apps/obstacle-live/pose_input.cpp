// SPDX-License-Identifier: BSD-3-Clause
#include "pose_input.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::json;

double numberOf(const Json& json, const char* key, bool required) {
    const auto it = json.find(key);
    if (it == json.end() && !required) return 0.0;
    if (it == json.end() || !it->is_number())
        throw std::invalid_argument(std::string("a pose needs a number \"") + key + "\"");
    return it->get<double>();
}

}  // namespace

StampedPose parsePoseLine(const std::string& line) { return parsePose(Json::parse(line, nullptr, false)); }

StampedPose parsePose(const Json& json) {
    if (!json.is_object()) throw std::invalid_argument("a pose is a line of JSON: {\"timestamp\": .., \"x\": .., ..}");
    StampedPose pose;
    pose.time = numberOf(json, "timestamp", true);
    pose.position = {numberOf(json, "x", true), numberOf(json, "y", true), numberOf(json, "z", false)};
    pose.orientation = Eigen::AngleAxisd(numberOf(json, "yaw", true), Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(numberOf(json, "pitch", false), Eigen::Vector3d::UnitY()) *
                       Eigen::AngleAxisd(numberOf(json, "roll", false), Eigen::Vector3d::UnitX());
    validate(pose);
    return pose;
}

void PoseInput::fetch(const Sink& sink) {
    constexpr int kMost = 64;  // calls, each of some datagrams at most: a flood must not stop the scans
    bool any = true;
    for (int k = 0; any && k < kMost; ++k) {
        any = false;
        udp_.receive(0.0, [&](const live::Datagram& datagram) {
            any = true;
            takeLines(datagram, sink);
        });
    }
}

void PoseInput::takeLines(const live::Datagram& datagram, const Sink& sink) {
    if (datagram.length > live::Datagram::kCapacity)
        return refuse("a datagram of poses holds " + std::to_string(live::Datagram::kCapacity) + " bytes at most");
    std::istringstream lines(std::string(datagram.bytes.begin(), datagram.bytes.begin() + datagram.length));
    for (std::string line; std::getline(lines, line);) {
        if (line.find_first_not_of(" \r\t") == std::string::npos) continue;
        try {
            sink(parsePoseLine(line));
            ++taken_;
        } catch (const std::invalid_argument& e) {
            refuse(e.what());
        }
    }
}

void PoseInput::refuse(const std::string& why) {
    if (refused_++ == 0) why_refused_ = why;
}

}  // namespace lidar_obstacles::apps
