// SPDX-License-Identifier: BSD-3-Clause
// Rawlogs: objects of MRPT, and the decoding of what they hold.
#include <cstdlib>
#include <new>

#include "fuzz/read_all.h"

// MRPT asks for as much memory as a damaged length says. The tools cap what they can get; here AddressSanitizer would
// end the program instead of throwing.
void* operator new(std::size_t size) {
    constexpr std::size_t kMost = std::size_t{1} << 26U;
    void* const memory = size > kMost ? nullptr : std::malloc(size);
    if (!memory) throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const lidar_obstacles::fuzz::MemoryFile file(data, size);
    lidar_obstacles::fuzz::readAll(file.path());
    return 0;
}
