/// @file
/// obstacle-live: obstacles from a lidar on the network. Parses, wires, reports.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <string>

#include "common/address_space.h"
#include "common/run_app.h"
#include "common/text_file.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "options.h"
#include "run.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");

void onSignal(int) { stop = true; }

/// The first signal ends the run; a second one ends the program.
void catchSignals() {
    struct sigaction action{};
    action.sa_handler = onSignal;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);  // a reader that went away is an error of write()
}

int runWith(const Options& options) {
    DetectorParams params = options.config.empty() ? DetectorParams{} : loadParams(options.config);
    for (const std::string& assignment : options.set) setParam(params, assignment);
    if (options.planes) setParam(params, "sensor.planes=" + std::to_string(*options.planes));
    validate(params);
    const RunResult result = run(options, params, stop);
    if (!options.statistics.empty()) writeTextFile(options.statistics, toJson(result.statistics));
    if (!result.error.empty()) throw std::runtime_error(result.error);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-live", [&] {
        capAddressSpace();
        catchSignals();
        cv::setNumThreads(1);
        const auto options = parseOptions(argc, argv);
        return options ? runWith(*options) : 0;
    });
}
