// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scans of a store through the detector, in any order.
#pragma once

#include <memory>
#include <optional>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/health.h"
#include "pose_index.h"
#include "scan_store.h"
#include "shown_scan.h"

namespace lidar_obstacles::apps {

/// What is found in a scan does not depend on which ones were asked for before: the next scan goes on from the last
/// one, for any other the detector first sees the scans that it would remember (scansRemembered()), and zones with it.
/// The health of the sensor depends on all scans before: it is watched only where that is asked for, and zones do not
/// know of it.
class Sequence {
  public:
    /// @param store  must outlive the sequence.
    /// @param poses  null: none are known or used.
    /// @throws as ObstacleDetector.
    Sequence(const ScanStore& store, std::shared_ptr<const PoseIndex> poses, DetectorSetup setup);

    /// True if the poses that belong to the scan, and to those that the detector would remember, are known.
    bool ready(std::size_t index) const;
    /// Uses the poses that are known. A scan that was not ready() is found anew when it is asked for again, and the
    /// next one does not build on it. A scan that cannot be right gives an empty one that says why.
    /// @throws std::invalid_argument if the parameters do not fit each other or the sensor; std::runtime_error if it
    ///     cannot be read.
    std::shared_ptr<ShownScan> process(std::size_t index);
    /// Watches the health of the sensor in the scans that are processed from now on: to be all, in their order.
    void watchHealth() { health_.emplace(); }
    /// After the last one; nothing is wrong where nobody watches.
    HealthReport health() const { return health_ ? health_->report() : HealthReport{}; }
    /// Forgets what was seen so far, but for the health.
    void restart() { last_.reset(); }

    const DetectorSetup& setup() const { return setup_; }

  private:
    std::shared_ptr<ShownScan> decode(std::size_t index) const;
    void forget();
    void warmUp(std::size_t index);
    SequenceResult detectIn(PointCloud cloud);

    const ScanStore& store_;
    std::shared_ptr<const PoseIndex> poses_;
    DetectorSetup setup_;
    ObstacleDetector detector_;
    std::optional<ZoneMonitor> zones_;
    std::optional<HealthMonitor> health_;
    TrackTails tails_;
    std::optional<std::size_t> last_;  ///< the scan that the detector has seen last
    std::optional<double> last_time_;  ///< up to there its poses are known [s]
};

}  // namespace lidar_obstacles::apps
