// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Quantiles of times, in constant memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lidar_obstacles::live {

/// Counts times in steps of 0.05 ms up to 500 ms; longer ones in the last step.
/// An object is for one thread at a time.
class LatencyHistogram {
  public:
    /// @param ms  negative ones (a clock was set) count as 0.
    void add(double ms);

    std::size_t count() const { return count_; }
    /// Upper end of the step that holds the q-quantile [ms]; of the last one the longest time seen. 0 if empty.
    double quantile(double q) const;
    double max() const { return max_; }  ///< [ms]

  private:
    static constexpr double kStep = 0.05;          ///< [ms]
    static constexpr std::size_t kSteps = 10'001;  ///< the last one is open

    std::array<std::uint32_t, kSteps> steps_{};
    std::size_t count_ = 0;
    double max_ = 0.0;
};

}  // namespace lidar_obstacles::live
