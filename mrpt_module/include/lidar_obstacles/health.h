// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Health of the sensor and of what it is fed with, judged by what the scans were like before: blocked sectors, silent
/// rings, a mount that turned, a wrong rate, lost poses.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"

namespace lidar_obstacles {

/// Azimuths around the sensor, counter-clockwise from +x of the vehicle frame, from `from` up to `to` [rad]; `to` may
/// be beyond pi.
struct AzimuthSpan {
    double from = 0.0;
    double to = 0.0;
};

/// What is wrong after a scan. Without faults all lists are empty and all flags false.
struct HealthReport {
    std::vector<AzimuthSpan> blocked;  ///< no returns come from where ground and structure were seen; rising
    std::vector<int> silent_rings;     ///< rings that fell silent while their neighbours went on; rising
    bool turned = false;               ///< the ground's normal jumped in the vehicle frame, and stays so
    double turned_by = 0.0;            ///< by how much [rad]
    bool wrong_rate = false;           ///< scans come at another rate than they did at first
    double rate = 0.0;                 ///< scans per second of late; 0: not known yet
    double usual_rate = 0.0;           ///< scans per second at first; 0: not known, or the stamps have no rate
    bool poses_lost = false;           ///< there were poses, and there are none now

    bool ok() const { return blocked.empty() && silent_rings.empty() && !turned && !wrong_rate && !poses_lost; }
};

/// One line for people, "blocked 30 to 60 deg, ring 5 silent"; "" if nothing is wrong. Degrees, from -180 to 180.
std::string toText(const HealthReport& report);

/// Watches scan after scan. Each fault is reported once it has lasted a second, and until it has been gone for a
/// second.
///
/// It compares with what this sensor saw before, so it knows nothing in the first seconds, and what was wrong from the
/// start is not found: a sector that was never seen is outside the sensor's field of view as far as it can tell. A
/// mount that turned about the vertical axis, or slowly, does not let the ground's normal jump, and is not found
/// either. Where time stamps run backwards or jump by more than two seconds, it begins anew.
/// An object is for one thread at a time.
class HealthMonitor {
  public:
    HealthMonitor();
    ~HealthMonitor();
    HealthMonitor(HealthMonitor&&) noexcept;
    HealthMonitor& operator=(HealthMonitor&&) noexcept;

    /// Takes in one scan with what was found in it. @return valid until the next call.
    const HealthReport& update(const SequenceResult& found);
    /// As of the last scan.
    const HealthReport& report() const;

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

}  // namespace lidar_obstacles
