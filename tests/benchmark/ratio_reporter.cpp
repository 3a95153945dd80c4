// SPDX-License-Identifier: BSD-3-Clause
#include "ratio_reporter.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>

#include "stages.h"

namespace lidar_obstacles::bench {
namespace {

/// The element whose `member` equals `name`; added at the end if there is none.
template <class T>
T& named(std::vector<T>& list, std::string T::* member, const std::string& name) {
    const auto at = std::find_if(list.begin(), list.end(), [&](const T& t) { return t.*member == name; });
    if (at != list.end()) return *at;
    list.emplace_back();
    list.back().*member = name;
    return list.back();
}

/// Decoding is no part of a grid method: it is held against MRPT's own.
bool isDecoding(const std::string& what) { return what.find("decode") != std::string::npos; }

}  // namespace

void RatioReporter::ReportRuns(const std::vector<Run>& runs) {
    for (const Run& run : runs) {
        const std::string& name = run.run_name.function_name;
        const std::size_t slash = name.find('/');
        if (run.run_type != Run::RT_Aggregate || slash == std::string::npos) continue;
        Table& table = named(tables_, &Table::data_set, name.substr(slash + 1));
        Row& row = named(table.rows, &Row::what, name.substr(0, slash));
        row.order = run.family_index;
        if (run.aggregate_name == "median") {
            row.median_ms = run.GetAdjustedCPUTime();
            table.points = run.counters.at("points").value;
        }
        if (run.aggregate_name == "p95") row.p95_ms = run.GetAdjustedCPUTime();
    }
}

void RatioReporter::Finalize() {
    // told in the order of registration: repetitions may run in random order
    const auto byOrder = [](const Row& a, const Row& b) { return a.order < b.order; };
    for (Table& table : tables_) std::sort(table.rows.begin(), table.rows.end(), byOrder);
    std::sort(tables_.begin(), tables_.end(),
              [](const Table& a, const Table& b) { return a.rows[0].order < b.rows[0].order; });
    for (const Table& table : tables_) print(table);
}

void RatioReporter::print(const Table& table) {
    const auto medianOf = [&table](const std::string& what) {
        const auto row =
            std::find_if(table.rows.begin(), table.rows.end(), [&](const Row& r) { return r.what == what; });
        return row == table.rows.end() ? 0.0 : row->median_ms;
    };
    std::ostream& out = GetOutputStream();
    out << "\n"
        << table.data_set << ", " << std::llround(table.points) << " points (CPU time, one thread)\n"
        << std::left << std::setw(14) << "" << std::right << std::setw(12) << "median ms" << std::setw(12) << "p95 ms"
        << std::setw(12) << "ns/point" << std::setw(12) << "x floor"
        << "\n"
        << std::fixed;
    for (const Row& row : table.rows) {
        const double reference = medianOf(isDecoding(row.what) ? "mrpt_decode" : kFloor);
        out << std::left << std::setw(14) << row.what << std::right << std::setprecision(3) << std::setw(12)
            << row.median_ms << std::setw(12) << row.p95_ms << std::setprecision(1) << std::setw(12)
            << 1e6 * row.median_ms / std::max(1.0, table.points) << std::setprecision(2) << std::setw(12)
            << (reference > 0.0 ? row.median_ms / reference : 0.0) << (isDecoding(row.what) ? "  x mrpt_decode" : "")
            << "\n";
    }
}

}  // namespace lidar_obstacles::bench
