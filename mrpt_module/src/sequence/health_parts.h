// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parts of the health monitor, each watching one thing.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "lidar_obstacles/health.h"

namespace lidar_obstacles {

/// A fault that is reported once it has lasted, until it has been gone as long.
class Lasting {
  public:
    /// @return whether it is reported.
    bool update(bool is_there, double time) {
        if (is_there == reported_) since_.reset();
        if (is_there != reported_ && !since_) since_ = time;
        if (since_ && time - *since_ >= kLong) {
            reported_ = is_there;
            since_.reset();
        }
        return reported_;
    }

  private:
    static constexpr double kLong = 0.95;  // a second, whatever the stamps jitter [s]
    bool reported_ = false;
    std::optional<double> since_;  ///< it is the other way round since then [s]
};

/// How many returns come from where, against what came before.
struct Share {
    double usual = 0.0;  ///< returns per scan of late
    double now = 0.0;    ///< in this scan
    Lasting missing;

    double ratio() const { return usual > 0.0 ? now / usual : 1.0; }
};

/// Blocked sectors and silent rings, of one cloud after the other.
class ReturnsWatch {
  public:
    /// @param dt  since the scan before [s]; 0: it is the first.
    void update(const PointCloud& cloud, double dt, HealthReport& report);

  private:
    void count(const PointCloud& cloud);
    void judgeSectors(double time, HealthReport& report);
    void judgeRings(const PointCloud& cloud, HealthReport& report);
    bool neighboursGoOn(const PointCloud& cloud, int ring) const;

    double watched_ = 0.0;        ///< [s]
    std::vector<Share> sectors_;  ///< of the returns below the sensor
    std::vector<Share> rings_;
};

/// The ground's normal in the vehicle frame.
class MountWatch {
  public:
    void update(const GroundModel& ground, double time, HealthReport& report);

  private:
    std::deque<std::pair<double, Eigen::Vector3d>> normals_;  ///< of a little more than a second: time [s], normal
    Eigen::Vector3d before_ = Eigen::Vector3d::UnitZ();       ///< the mount turned
};

/// The rate of the scans.
class RateWatch {
  public:
    /// @param dt  since the scan before [s].
    void update(double dt, HealthReport& report);

  private:
    std::vector<double> first_;  ///< intervals, until the usual one is known [s]
    std::deque<double> late_;    ///< of the last second [s]
};

/// Whether the pose is known.
class PoseWatch {
  public:
    void update(const SequenceResult& found, double dt, HealthReport& report);

  private:
    double known_ = 0.0;  ///< for so long [s]
    Lasting lost_;
};

}  // namespace lidar_obstacles
