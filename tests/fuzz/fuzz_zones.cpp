// SPDX-License-Identifier: BSD-3-Clause
// Zone files.
#include <string>

#include "lidar_obstacles/mrpt_bridge/zones_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lidar_obstacles;
    try {
        parseZones({reinterpret_cast<const char*>(data), size}, "fuzz");
    } catch (const ZonesFileError&) {
        // refused
    }
    return 0;
}
