// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-replay: obstacles from the lidar scans of a rawlog or a capture. Parses, wires, reports.
#include <cstdio>
#include <opencv2/core/utility.hpp>
#include <stdexcept>
#include <string>

#include "common/address_space.h"
#include "common/interrupt.h"
#include "common/read_params.h"
#include "common/rereadable_input.h"
#include "common/run_app.h"
#include "gui/window.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "options.h"
#include "outputs.h"
#include "replay.h"
#include "summary.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

/// --planes N is one more --set.
DetectorParams paramsOf(const Options& options) {
    std::vector<std::string> set = options.set;
    if (options.planes) set.push_back("sensor.planes=" + std::to_string(*options.planes));
    return readParams(options.config, set);
}

void printResult(const Summary& summary, const Options& options) {
    std::size_t obstacles = 0;
    for (const auto& [name, count] : summary.obstacles) obstacles += count;
    if (!summary.remarks.empty()) std::fprintf(stderr, "obstacle-replay: %s\n", summary.remarks.c_str());
    std::printf("%zu scans, %zu returns, %zu obstacles: see %s\n", summary.scans, summary.returns, obstacles,
                options.output.c_str());
    const std::string poses = summary.motion.text();
    if (!poses.empty()) std::printf("%s\n", poses.c_str());
}

/// Writes what was learnt of the own body, if anything. @return what to say of it.
std::string offerOwnBody(const Summary& summary, const Options& options, Outputs& outputs) {
    if (!summary.moved)
        return "own body: not learnt: the vehicle hardly moves in these scans, or they are fewer than 20\n";
    if (summary.in_place.empty()) return "own body: none: nothing stays in place around the vehicle\n";
    const std::string file = outputs.writeOwnBody(
        summary.in_place, "own body, learnt from " + std::to_string(summary.scans) + " scans of " + options.input);
    return "own body: " + std::to_string(summary.in_place.parts().size()) +
           " boxes; look at them in a picture, then use them with --set region.own_body=@" + file + "\n";
}

/// Why the run ended before the recording did; empty if it did not.
std::string endOf(const Summary& summary) {
    if (summary.interrupted_at)
        return "The run was interrupted at scan " + std::to_string(*summary.interrupted_at) + ".";
    return summary.damage.empty() ? "" : "The input ends here: " + summary.damage + ".";
}

int run(const Options& options) {
    const DetectorParams params = paramsOf(options);
    if (options.print_config) {
        std::fputs(dumpParams(params).c_str(), stdout);
        if (std::fflush(stdout) != 0) throw std::runtime_error("cannot write to the standard output");
        return 0;
    }
    if (options.show.gui) {
        showWindow(options, params);
        return 0;
    }
    auto source = openInput(options.input, options.choice);
    catchInterrupts();
    Outputs outputs(options, params);
    source = outputs.annotate(std::move(source), options, params);
    if (!options.show.record.empty()) outputs.startRecording(options, params);
    const Summary summary = replay(*source, options, params, outputs);
    const std::string own_body = options.learn_own_body ? offerOwnBody(summary, options, outputs) : "";
    outputs.finish(toJson(summary, options, params), endOf(summary));
    printResult(summary, options);
    std::fputs(own_body.c_str(), stdout);
    if (!summary.damage.empty()) throw std::runtime_error(summary.damage);
    return exitCode("obstacle-replay", summary.interrupted_at);
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-replay", [&] {
        capAddressSpace();
        cv::setNumThreads(1);  // one core is the promise, and small images lose more than they win
        auto options = parseOptions(argc, argv);
        if (!options) return 0;
        const RereadableInput input(options->input);
        options->input = input.path();
        return run(*options);
    });
}
