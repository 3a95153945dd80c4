// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Instead of Google Benchmark's rows one table per data set, with ratios to the floor of the same run.
#pragma once

#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_obstacles::bench {

class RatioReporter : public benchmark::ConsoleReporter {
  public:
    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

  private:
    struct Row {
        std::string what;
        std::int64_t order = 0;
        double median_ms = 0.0;
        double p95_ms = 0.0;
    };
    struct Table {
        std::string data_set;
        double points = 0.0;
        std::vector<Row> rows;
    };

    void print(const Table& table);

    std::vector<Table> tables_;
};

}  // namespace lidar_obstacles::bench
