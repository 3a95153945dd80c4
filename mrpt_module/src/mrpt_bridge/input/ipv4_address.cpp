// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/ipv4_address.h"

#include <arpa/inet.h>

#include <stdexcept>

namespace lidar_obstacles {

std::uint32_t parseAddress(const std::string& text) {
    in_addr address{};
    if (inet_pton(AF_INET, text.c_str(), &address) != 1)
        throw std::invalid_argument(text + ": not an IPv4 address such as 192.168.1.77");
    return ntohl(address.s_addr);
}

std::string addressText(std::uint32_t address) {
    std::string text;
    for (unsigned shift = 32; shift > 0; shift -= 8)
        text += (text.empty() ? "" : ".") + std::to_string(address >> (shift - 8) & 0xffU);
    return text;
}

}  // namespace lidar_obstacles
