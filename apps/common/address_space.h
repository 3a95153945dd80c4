/// @file
/// A cap on the memory of a tool. The library never sets one.
#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace lidar_obstacles {

/// True where the cap can be set: AddressSanitizer reserves terabytes of address space and does not live with one.
constexpr bool canCapAddressSpace() {
#if defined(__SANITIZE_ADDRESS__)
    return false;
#else
    return true;
#endif
}

/// Caps the address space of this process, so that a size field gone wrong in a damaged file ends in std::bad_alloc
/// (reported as damage of the file) instead of eating the machine's memory. A stricter limit that is already set stays.
/// @param bytes  the default is several times what the tools need, picture rendering included.
/// @return false if no cap was set.
inline bool capAddressSpace(std::uint64_t bytes = std::uint64_t{4} << 30U) {
    rlimit limit{};
    if (!canCapAddressSpace() || getrlimit(RLIMIT_AS, &limit) != 0) return false;
    if (limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur <= bytes) return true;
    limit.rlim_cur = bytes;
    return setrlimit(RLIMIT_AS, &limit) == 0;
}

}  // namespace lidar_obstacles
