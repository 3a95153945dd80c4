// SPDX-License-Identifier: BSD-3-Clause
#include "scan/looked_columns.h"

#include <algorithm>
#include <cstdint>

namespace lidar_obstacles {
namespace {

/// Of each column: did any ring bring something back?
std::vector<std::uint8_t> columnsWithReturns(const OrganizedView& view) {
    std::vector<std::uint8_t> seen(static_cast<std::size_t>(view.columns), 0);
    for (int ring = 0; ring < view.rings; ++ring) {
        const std::int32_t* row = &view.index[static_cast<std::size_t>(ring) * seen.size()];
        for (std::size_t column = 0; column < seen.size(); ++column)
            seen[column] |= static_cast<std::uint8_t>(row[column] >= 0);
    }
    return seen;
}

struct Stretch {
    int first = 0;
    int columns = 0;
};

/// Stretches of columns without a return, around the circle; none where all are.
std::vector<Stretch> emptyStretches(const std::vector<std::uint8_t>& seen) {
    std::vector<Stretch> empty;
    const auto n = static_cast<int>(seen.size());
    const auto start = static_cast<int>(std::find(seen.begin(), seen.end(), 1) - seen.begin());
    for (int k = 0; start < n && k < n; ++k) {
        const int column = (start + k) % n;
        if (seen[static_cast<std::size_t>(column)] != 0) continue;
        const bool goes_on = !empty.empty() && (empty.back().first + empty.back().columns) % n == column;
        if (!goes_on) empty.push_back({column, 0});
        ++empty.back().columns;
    }
    return empty;
}

/// Marks the holes with 1.
std::vector<std::uint8_t> holesOf(const std::vector<std::uint8_t>& seen) {
    const auto n = static_cast<int>(seen.size());
    std::vector<std::uint8_t> hole(seen.size(), 0);
    int within = n, missing = 0;  // columns that the sensor looks at, and those without a return
    std::vector<Stretch> holes;
    for (const Stretch& s : emptyStretches(seen)) {
        if (s.columns > kColumnsOfPacket) {
            within -= s.columns;
            continue;
        }
        missing += s.columns;
        holes.push_back(s);
    }
    if (4 * missing > within) return hole;
    for (const Stretch& s : holes)
        for (int k = 0; k < s.columns; ++k) hole[static_cast<std::size_t>((s.first + k) % n)] = 1;
    return hole;
}

}  // namespace

LookedColumns::LookedColumns(const OrganizedView& view) {
    if (view.empty()) return;
    const std::vector<std::uint8_t> hole = holesOf(columnsWithReturns(view));
    place_.reserve(hole.size());
    column_.reserve(hole.size());
    for (std::size_t column = 0; column < hole.size(); ++column) {
        if (hole[column] == 0) column_.push_back(static_cast<int>(column));
        place_.push_back(static_cast<int>(column_.size()) - 1);
    }
    for (int& place : place_)  // in a hole that begins before the first column
        if (place < 0) place = count() - 1;
}

}  // namespace lidar_obstacles
