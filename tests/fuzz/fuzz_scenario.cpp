// SPDX-License-Identifier: BSD-3-Clause
// Scenario files of the simulator.
#include <cmath>
#include <cstdlib>
#include <string>

#include "lidar_obstacles/simulation/scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace lidar_obstacles::simulation;
    try {
        const Scenario scenario = parseScenario({reinterpret_cast<const char*>(data), size}, "fuzz");
        if (!std::isfinite(durationOf(scenario))) std::abort();
    } catch (const ScenarioError&) {
        // refused
    }
    return 0;
}
