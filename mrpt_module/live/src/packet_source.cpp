// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/packet_source.h"

#include <arpa/inet.h>

#include <charconv>
#include <chrono>
#include <stdexcept>

namespace lidar_obstacles::live {

double wallClock() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

std::uint32_t parseAddress(const std::string& text) {
    in_addr address{};
    if (inet_pton(AF_INET, text.c_str(), &address) != 1)
        throw std::invalid_argument(text + ": not an IPv4 address such as 192.168.1.77");
    return ntohl(address.s_addr);
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

std::string addressText(std::uint32_t address) {
    std::string text;
    for (unsigned shift = 32; shift > 0; shift -= 8)
        text += (text.empty() ? "" : ".") + std::to_string(address >> (shift - 8) & 0xffU);
    return text;
}

std::string toString(const Endpoint& endpoint) {
    return addressText(endpoint.address) + ':' + std::to_string(endpoint.port);
}

}  // namespace lidar_obstacles::live
