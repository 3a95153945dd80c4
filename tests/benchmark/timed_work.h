// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One benchmark of one piece of work on one data set.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <vector>

#include "data_sets.h"

namespace lidar_obstacles::bench {

inline constexpr int kRepetitions = 31;
inline constexpr double kSecondsPerRepetition = 0.02;

inline double percentile95(const std::vector<double>& values) {
    std::vector<double> sorted = values;
    const std::size_t at = (sorted.size() * 95) / 100;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(at), sorted.end());
    return sorted[at];
}

/// Times `work()`, whose result is used only to keep the compiler from leaving it out.
template <class Work>
void add(const std::string& what, const DataSet& set, Work work) {
    const auto points = static_cast<double>(set.cloud.size());
    benchmark::RegisterBenchmark((what + "/" + set.name).c_str(),
                                 [work, points](benchmark::State& state) {
                                     for (auto _ : state) {
                                         auto result = work();
                                         benchmark::DoNotOptimize(result);
                                     }
                                     state.counters["points"] = points;
                                 })
        ->Unit(benchmark::kMillisecond)
        ->Repetitions(kRepetitions)
        ->MinTime(kSecondsPerRepetition)
        ->ComputeStatistics("p95", percentile95)
        ->ReportAggregatesOnly();
}

}  // namespace lidar_obstacles::bench
