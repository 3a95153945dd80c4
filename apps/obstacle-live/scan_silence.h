// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// For how long scans stay away, and what time it is by their stamps.
#pragma once

#include <optional>

namespace lidar_obstacles::apps {

/// Tells who reads results that scans stay away, again and again. All times but stamps are by steadyClock(): the
/// system's clock may be set while nothing comes.
class ScanSilence {
  public:
    static constexpr double kPatience = 0.4;  ///< [s]

    explicit ScanSilence(double now) : last_line_(now) {}

    /// Results of a scan went out. @param stamp  of the scan, seconds since the epoch.
    void end(double now, double stamp) {
        last_line_ = now;
        stamp_offset_ = stamp - now;
    }

    /// @param without_scans  the stamp where no scan has come yet; none: nothing is told then.
    /// @return the stamp of the line that is to go out now; none while it is not its time.
    std::optional<double> tell(double now, std::optional<double> without_scans) {
        const std::optional<double> stamp = stamp_offset_ ? now + *stamp_offset_ : without_scans;
        if (!stamp || now - last_line_ < kPatience) return std::nullopt;
        last_line_ = now;
        return stamp;
    }

  private:
    double last_line_;                    ///< when one went out
    std::optional<double> stamp_offset_;  ///< from steadyClock() to the stamps of the scans
};

}  // namespace lidar_obstacles::apps
