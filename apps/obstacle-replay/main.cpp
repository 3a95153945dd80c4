/// @file
/// obstacle-replay: obstacles from the lidar scans of a rawlog or a capture. Parses, wires, reports.
#include <cstdio>
#include <exception>
#include <opencv2/core/utility.hpp>
#include <string>

#include "common/address_space.h"
#include "common/message_of.h"
#include "gui/window.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "options.h"
#include "outputs.h"
#include "replay.h"
#include "summary.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

DetectorParams readParams(const Options& options) {
    DetectorParams params = options.config.empty() ? DetectorParams{} : loadParams(options.config);
    for (const std::string& assignment : options.set) setParam(params, assignment);
    if (options.planes) setParam(params, "sensor.planes=" + std::to_string(*options.planes));
    validate(params);
    return params;
}

int report(int code, const std::string& message) {
    std::fprintf(stderr, "obstacle-replay: error: %s\n", message.c_str());
    return code;
}

void printResult(const Summary& summary, const Options& options) {
    std::size_t obstacles = 0;
    for (const auto& [name, count] : summary.obstacles) obstacles += count;
    if (!summary.remarks.empty()) std::fprintf(stderr, "obstacle-replay: %s\n", summary.remarks.c_str());
    std::printf("%zu scans, %zu returns, %zu obstacles: see %s\n", summary.scans, summary.returns, obstacles,
                options.output.c_str());
}

int run(const Options& options) {
    const DetectorParams params = readParams(options);
    if (options.print_config) {
        std::fputs(dumpParams(params).c_str(), stdout);
        return std::fflush(stdout) == 0 ? 0 : report(1, "cannot write to the standard output");
    }
    if (options.show.gui) {
        showWindow(options, params);
        return 0;
    }
    auto source = openScanSource(options.input);
    Outputs outputs(options);
    source = outputs.annotate(std::move(source), options, params);
    if (!options.show.record.empty()) outputs.startRecording(options, params);
    const Summary summary = replay(*source, options, params, outputs);
    outputs.finish(toJson(summary, options, params));
    printResult(summary, options);
    return summary.damage.empty() ? 0 : report(1, summary.damage);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        capAddressSpace();
        cv::setNumThreads(1);  // one core is the promise, and small images lose more than they win
        const auto options = parseOptions(argc, argv);
        return options ? run(*options) : 0;
    } catch (const UsageError& e) {
        return report(2, e.what());
    } catch (const ConfigError& e) {
        return report(2, e.what());
    } catch (const std::invalid_argument& e) {  // parameters that do not go together or do not fit the sensor
        return report(2, e.what());
    } catch (const std::bad_alloc&) {
        return report(1, "out of memory");
    } catch (const std::exception& e) {
        return report(1, messageOf(e));
    }
}
