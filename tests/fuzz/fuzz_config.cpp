// SPDX-License-Identifier: BSD-3-Clause
// Config files: what is taken can be written and read again.
#include <cstdlib>
#include <string>

#include "lidar_obstacles/mrpt_bridge/config_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lidar_obstacles;
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const std::string again = dumpParams(parseParams(text, "fuzz"));
        if (dumpParams(parseParams(again, "dump")) != again) std::abort();
    } catch (const ConfigError&) {
        // refused
    }
    try {
        DetectorParams params;
        setParam(params, text);
    } catch (const ConfigError&) {
        // refused
    }
    return 0;
}
