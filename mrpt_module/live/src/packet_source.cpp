// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/packet_source.h"

#include <charconv>
#include <chrono>
#include <stdexcept>

namespace lidar_obstacles::live {

double wallClock() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

double steadyClock() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Endpoint parseEndpoint(const std::string& text, const Endpoint& usual) {
    Endpoint endpoint = usual;
    const auto colon = text.find(':');
    if (colon != 0) endpoint.address = parseAddress(text.substr(0, colon));
    if (colon == std::string::npos) return endpoint;
    const char* const end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data() + colon + 1, end, endpoint.port);
    if (error != std::errc() || at != end) throw std::invalid_argument(text + ": the port must be 0 .. 65535");
    return endpoint;
}

std::string toString(const Endpoint& endpoint) {
    return addressText(endpoint.address) + ':' + std::to_string(endpoint.port);
}

}  // namespace lidar_obstacles::live
