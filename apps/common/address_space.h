// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A cap on the memory of a tool. The library never sets one.
#pragma once

#include <cstdint>

namespace lidar_obstacles {

/// True where the cap can be set: AddressSanitizer and ThreadSanitizer reserve terabytes of address space and do not
/// live with one.
constexpr bool canCapAddressSpace() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return false;
#else
    return true;
#endif
}

/// Caps the address space of this process, so that a size field gone wrong in a damaged file ends in std::bad_alloc
/// (reported as damage of the file) instead of eating the machine's memory. A stricter limit that is already set stays.
/// A program that has this function also has an mrpt::aligned_malloc that throws where there is no memory: MRPT's own
/// returns null, and its containers write there.
/// @param bytes  the default is several times what the tools need, picture rendering included.
/// @return false if no cap was set.
bool capAddressSpace(std::uint64_t bytes = std::uint64_t{4} << 30U);

}  // namespace lidar_obstacles
