// SPDX-License-Identifier: BSD-3-Clause
#include "common/address_space.h"

#include <dlfcn.h>
#include <mrpt/core/aligned_allocator.h>
#include <sys/resource.h>

#include <new>

// Stands before the one of MRPT's library, for MRPT's other libraries as well.
void* mrpt::aligned_malloc(std::size_t size, std::size_t alignment) {
    using Malloc = void* (*)(std::size_t, std::size_t);
    static const auto of_mrpt = reinterpret_cast<Malloc>(dlsym(RTLD_NEXT, "_ZN4mrpt14aligned_mallocEmm"));
    void* const memory = of_mrpt ? of_mrpt(size, alignment) : nullptr;
    if (!memory && size > 0) throw std::bad_alloc();
    return memory;
}

namespace lidar_obstacles {

bool capAddressSpace(std::uint64_t bytes) {
    rlimit limit{};
    if (!canCapAddressSpace() || getrlimit(RLIMIT_AS, &limit) != 0) return false;
    if (limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur <= bytes) return true;
    limit.rlim_cur = bytes;
    return setrlimit(RLIMIT_AS, &limit) == 0;
}

}  // namespace lidar_obstacles
