// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The detector of a live run, and what its parameters change on the way.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/health.h"
#include "lidar_obstacles/live/live_detector.h"
#include "lidar_obstacles/zones.h"
#include "log.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// A LiveDetector with its health and zones. Parameters may be changed between two scans: the detector begins anew
/// then, but knows the latest poses, and ids go on.
class LiveDetection {
  public:
    /// @param log  takes what the detector does without; outlives it.
    /// @throws as LiveDetector; UsageError naming file and line if the zones are not right.
    LiveDetection(const Options& options, const DetectorParams& params, const Log& log);

    /// "section.key=value" each, as strict as config.ini: all of them or none.
    /// @throws ConfigError, std::invalid_argument, std::runtime_error saying why nothing was changed.
    void set(const std::vector<std::string>& assignments);

    void addPose(const StampedPose& pose);
    /// The cloud of the scans that belong together, see LiveDetector::decode().
    live::JoinedDecode decode(std::vector<live::LiveScan> scans);
    /// Searches it, and watches health and zones. @param last_arrival  of its last packet, by steadyClock() [s]
    SequenceResult process(PointCloud cloud, double last_arrival);

    const DetectorParams& params() const { return params_; }
    const ObstacleDetector& detector() const { return detector_->detector(); }
    const HealthReport& health() const { return health_.report(); }
    ZoneMonitor* zones() { return zones_ ? &*zones_ : nullptr; }

  private:
    void tryOn(const DetectorParams& params, const live::LiveDetector& detector) const;

    const Options& options_;
    const Log& log_;
    DetectorParams params_;
    std::unique_ptr<live::LiveDetector> detector_;
    HealthMonitor health_;
    std::optional<ZoneMonitor> zones_;
    std::vector<live::LiveScan> last_scans_;  ///< that belonged together
    std::deque<StampedPose> poses_;           ///< the latest
    int first_id_ = 0;                        ///< of this detector
    int next_id_ = 0;                         ///< after all that were given
    bool begins_ = false;                     ///< the next scan is its first, after others
};

}  // namespace lidar_obstacles::apps
