// SPDX-License-Identifier: BSD-3-Clause
// Captures: link layers, fragments, packets, turns, decoding.
#include <string>

#include "fuzz/read_all.h"

/// What does not begin as a capture would be read as a rawlog, which has a target of its own.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string kMagic = "\xd4\xc3\xb2\xa1";
    std::string content(reinterpret_cast<const char*>(data), size);
    content.replace(0, std::min(content.size(), kMagic.size()), kMagic);
    const lidar_obstacles::fuzz::MemoryFile file(reinterpret_cast<const std::uint8_t*>(content.data()), content.size());
    lidar_obstacles::fuzz::readAll(file.path());
    return 0;
}
