// SPDX-License-Identifier: BSD-3-Clause
// Times the stages and the pipeline; ratios to what any grid method has to do, measured in the same run.
#include <benchmark/benchmark.h>

#include <exception>
#include <fstream>
#include <iostream>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "data_sets.h"
#include "ratio_reporter.h"
#include "stages.h"

namespace {

std::string cpuModel() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
    return "unknown";
}

void describeRun(const std::vector<lidar_obstacles::bench::DataSet>& sets) {
    benchmark::AddCustomContext("cpu", cpuModel());
    benchmark::AddCustomContext("compiler", std::string("g++ ") + __VERSION__);
    std::string names;
    for (const auto& set : sets) names += (names.empty() ? "" : ", ") + set.name;
    benchmark::AddCustomContext("data_sets", names);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        // Interleaved repetitions meet the same disturbances, so that ratios hold on a busy machine; flags may undo it.
        std::string interleave = "--benchmark_enable_random_interleaving=true";
        std::vector<char*> arguments(argv, argv + argc);
        arguments.insert(arguments.begin() + 1, interleave.data());
        argv = arguments.data();
        argc = static_cast<int>(arguments.size());
        benchmark::Initialize(&argc, argv);
        if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
        cv::setNumThreads(1);
        const auto sets = lidar_obstacles::bench::loadDataSets();
        describeRun(sets);
        for (const auto& set : sets) lidar_obstacles::bench::registerBenchmarks(set);
        lidar_obstacles::bench::RatioReporter reporter;
        benchmark::RunSpecifiedBenchmarks(&reporter);
        benchmark::Shutdown();
        return 0;
    } catch (const std::exception& e) {
        std::cerr << "error: " << e.what() << "\n";
        return 1;
    }
}
