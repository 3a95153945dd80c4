// SPDX-License-Identifier: BSD-3-Clause
// What clients of the live detector ask for, and poses from the network: a line of JSON each.
#include <stdexcept>
#include <string>

#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "obstacle-live/pose_input.h"
#include "obstacle-live/requests.h"

namespace {

using namespace lidar_obstacles;

void set(const apps::SetParameters& request) {
    try {
        DetectorParams params;
        for (const std::string& assignment : request.assignments) setParam(params, assignment);
    } catch (const ConfigError&) {
        // refused
    }
}

void takeRequest(const std::string& line) {
    try {
        const apps::Request request = apps::parseRequest(line);
        static_cast<void>(apps::okLine(line));
        if (const auto* const parameters = std::get_if<apps::SetParameters>(&request)) set(*parameters);
        if (const auto* const pose = std::get_if<apps::GivePose>(&request)) validate(pose->pose);
    } catch (const std::invalid_argument& e) {
        static_cast<void>(apps::errorLine(e.what(), line));
    }
}

void takePose(const std::string& line) {
    try {
        validate(apps::parsePoseLine(line));
    } catch (const std::invalid_argument&) {
        // refused
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string line(reinterpret_cast<const char*>(data), size);
    if (!line.empty()) static_cast<void>(apps::isHttp(line));
    takeRequest(line);
    takePose(line);
    return 0;
}
