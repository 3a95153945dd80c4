// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A progress bar on stderr, for people: nothing is drawn where stderr is no terminal.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

namespace lidar_obstacles::apps {

/// One line that is drawn anew at most five times a second: share, scans per second, time left.
class ProgressBar {
  public:
    ProgressBar() : enabled_(isatty(STDERR_FILENO) == 1) {}
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// @param share  of the work that is done, 0 .. 1.
    void update(double share, std::size_t scans) {
        const auto now = Clock::now();
        if (!enabled_ || now - drawn_ < std::chrono::milliseconds(200)) return;
        drawn_ = now;
        const double elapsed = std::chrono::duration<double>(now - start_).count();
        const double done = std::clamp(share, 0.0, 1.0);
        const double left = done > 0.0 ? elapsed * (1.0 - done) / done : 0.0;
        const std::string bar(static_cast<std::size_t>(done * kWidth), '#');
        std::fprintf(stderr, "\r\033[K[%-*s] %3.0f %%  %zu scans, %.1f/s, %.0f s left", kWidth, bar.c_str(),
                     100.0 * done, scans, static_cast<double>(scans) / std::max(elapsed, 1e-3), left);
        std::fflush(stderr);
    }

    /// Takes the line away, for messages and at the end.
    void clear() const {
        if (enabled_) std::fputs("\r\033[K", stderr);
    }

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr int kWidth = 30;

    const bool enabled_;
    const Clock::time_point start_ = Clock::now();
    Clock::time_point drawn_ = start_ - std::chrono::seconds(1);
};

}  // namespace lidar_obstacles::apps
