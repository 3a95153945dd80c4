// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-live: obstacles from a lidar on the network. Parses, wires, reports.
#include <csignal>
#include <cstdio>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <string>

#include "common/address_space.h"
#include "common/interrupt.h"
#include "common/read_params.h"
#include "common/run_app.h"
#include "common/text_file.h"
#include "lidar_obstacles/scan_matching.h"
#include "options.h"
#include "run.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

int runWith(const Options& options) {
    std::vector<std::string> set = options.set;
    if (options.planes) set.push_back("sensor.planes=" + std::to_string(*options.planes));
    const DetectorParams params = readParams(options.config, set);
    if (matchesScans(params.ego) && (options.poses || options.standing_at))
        throw UsageError("[ego] source = matching makes the poses: without --poses and --standing-at");
    const RunResult result = run(options, params, interruption());
    if (!options.statistics.empty()) writeTextFile(options.statistics, toJson(result.statistics));
    if (!result.error.empty()) throw std::runtime_error(result.error);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-live", [&] {
        capAddressSpace();
        catchInterrupts();
        std::signal(SIGPIPE, SIG_IGN);  // a reader that went away is an error of write()
        cv::setNumThreads(1);
        const auto options = parseOptions(argc, argv);
        return options ? runWith(*options) : 0;
    });
}
