// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// IPv4 addresses as text.
#pragma once

#include <cstdint>
#include <string>

namespace lidar_obstacles {

/// "192.168.1.77", first byte highest. @throws std::invalid_argument if it is none.
std::uint32_t parseAddress(const std::string& text);

/// "192.168.1.77" @param address  first byte highest.
std::string addressText(std::uint32_t address);

}  // namespace lidar_obstacles
