// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Numbers as bytes, the lowest byte first, whatever the machine.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace lidar_obstacles::apps {

/// Appends an integer.
template <typename Integer>
void putInteger(std::string& bytes, Integer value) {
    static_assert(std::is_integral_v<Integer>);
    auto rest = static_cast<std::make_unsigned_t<Integer>>(value);
    for (std::size_t k = 0; k < sizeof(Integer); ++k) {
        bytes += static_cast<char>(static_cast<std::uint8_t>(rest & 0xFFU));
        rest = static_cast<decltype(rest)>(static_cast<std::uint64_t>(rest) >> 8U);
    }
}

/// Appends an IEEE float of four bytes.
inline void putFloat(std::string& bytes, float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    putInteger(bytes, bits);
}

}  // namespace lidar_obstacles::apps
