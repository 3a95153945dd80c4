// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Further sensors of the vehicle, whose scans join those of the first.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/live/live_scanner.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// Listens to each further sensor on a thread of its own.
class SensorsBeside {
  public:
    static constexpr double kApart = 0.15;  ///< more than the turn before, where the nearest has not ended yet [s]

    /// @throws std::runtime_error naming the option and the endpoint if it cannot be bound.
    explicit SensorsBeside(const Options& options);

    /// The scan of each that began nearest to this time [s], of those that ended, if it is within kApart: waits for
    /// none. To be asked for rising times.
    std::vector<live::LiveScan> at(double time);
    /// Ends the reading; what was read is not delivered any more.
    void stop();
    /// What the sensors' streams have to say, each line with the place it comes from.
    std::vector<std::string> takeReports();
    /// How often a sensor had no scan for at().
    std::size_t missing() const { return missing_; }

  private:
    struct Sensor {
        std::string place;
        std::unique_ptr<live::LiveScanner> scanner;
        std::vector<live::LiveScan> last;  ///< two at most
    };
    std::vector<Sensor> sensors_;
    std::size_t missing_ = 0;
};

}  // namespace lidar_obstacles::apps
