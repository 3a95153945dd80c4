// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/latency.h"

#include <algorithm>

namespace lidar_obstacles::live {

void LatencyHistogram::add(double ms) {
    const double value = std::max(ms, 0.0);
    ++steps_[static_cast<std::size_t>(std::min(value / kStep, static_cast<double>(kSteps - 1)))];
    ++count_;
    max_ = std::max(max_, value);
}

double LatencyHistogram::quantile(double q) const {
    if (count_ == 0) return 0.0;
    const double wanted = std::clamp(q, 0.0, 1.0) * static_cast<double>(count_);
    std::size_t below = 0;
    for (std::size_t i = 0; i + 1 < kSteps; ++i) {
        below += steps_[i];
        if (static_cast<double>(below) >= wanted && below > 0) return kStep * static_cast<double>(i + 1);
    }
    return max_;
}

}  // namespace lidar_obstacles::live
