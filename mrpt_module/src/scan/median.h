// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lidar_obstacles {

/// The middle one of some numbers, the upper of the two where their count is even; changes their order. There is at
/// least one.
template <class Number>
Number medianOf(std::vector<Number>& numbers) {
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::nth_element(numbers.begin(), middle, numbers.end());
    return *middle;
}

}  // namespace lidar_obstacles
